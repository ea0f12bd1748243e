#pragma once
/// Bytes of plain data in and out, for checkpoints: same machine, same build. Nothing here is a file format for others.
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "dem/neighbours/raw_array.h"

namespace venato::dem {

class ByteWriter {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_destructible_v<T>);  // plain data; Eigen's fixed sizes are, though not formally trivially copyable
    append(&v, sizeof(T));
  }
  template <class T>
  void list(const std::vector<T>& v) {
    static_assert(std::is_trivially_destructible_v<T>);  // plain data; Eigen's fixed sizes are, though not formally trivially copyable
    value(static_cast<std::uint64_t>(v.size()));
    append(v.data(), v.size() * sizeof(T));
  }
  template <class T>
  void raw(const RawArray<T>& v) {
    value(static_cast<std::uint64_t>(v.size()));
    append(v.data(), v.size() * sizeof(T));
  }
  std::vector<std::uint8_t> bytes;

 private:
  void append(const void* p, std::size_t n) {
    if (n == 0) return;
    const std::size_t at = bytes.size();
    bytes.resize(at + n);
    std::memcpy(bytes.data() + at, p, n);
  }
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> b) : bytes_(b) {}
  template <class T>
  void value(T& v) {
    need(sizeof(T));
    std::memcpy(static_cast<void*>(&v), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
  }
  template <class T>
  void list(std::vector<T>& v) {
    std::uint64_t n = 0;
    value(n);
    if (n > (bytes_.size() - at_) / sizeof(T)) need(bytes_.size());
    v.resize(static_cast<std::size_t>(n));
    if (n > 0) std::memcpy(static_cast<void*>(v.data()), bytes_.data() + at_, v.size() * sizeof(T));
    at_ += v.size() * sizeof(T);
  }
  template <class T>
  void raw(RawArray<T>& v) {
    std::uint64_t n = 0;
    value(n);
    if (n > (bytes_.size() - at_) / sizeof(T)) need(bytes_.size());
    v.resize_for_overwrite(static_cast<std::size_t>(n));
    if (n > 0) std::memcpy(static_cast<void*>(v.data()), bytes_.data() + at_, v.size() * sizeof(T));
    at_ += v.size() * sizeof(T);
  }
  bool done() const { return at_ == bytes_.size(); }

 private:
  void need(std::size_t n) const {
    if (n > bytes_.size() - at_) throw WorkError("DEM state: the saved state ends too early (truncated checkpoint)");
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};
}  // namespace venato::dem
