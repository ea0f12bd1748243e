#pragma once
#include <hdf5.h>

#include <filesystem>
#include <string>
#include <utility>
namespace venato::h5 {

/// Owner of one HDF5 identifier; the right close function goes with it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, H5I_INVALID_HID);
      close_ = other.close_;
    }
    return *this;
  }
  ~Handle() { reset(); }
  /// \return the close function's answer, >= 0 when there was nothing to close
  herr_t reset() { return id_ >= 0 ? close_(std::exchange(id_, H5I_INVALID_HID)) : 0; }
  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// HDF5 prints its error stack to stderr by default; ours goes into the WorkError instead.
void silence_error_stack();
/// Throws WorkError "<path>: <doing> <what>: <deepest reason of the error stack>".
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& doing);
/// The identifier when it is valid, else fail().
Handle checked(hid_t id, Handle::Close close, const std::filesystem::path& path, const std::string& doing);
void check(herr_t status, const std::filesystem::path& path, const std::string& doing);
/// Fixed-length, null-padded UTF-8. \param length bytes >= 1
Handle text_type(std::size_t length);
}  // namespace venato::h5
