#include <algorithm>
#include <system_error>

#include "base/error.h"
#include "base/h5/h5_file.h"
#include "base/h5/h5_handle_h5.h"

namespace venato {
namespace fs = std::filesystem;
using h5::Handle;
namespace {
std::string trimmed(std::string text) {
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}
}  // namespace

struct H5Reader::Impl {
  fs::path path;
  Handle file;

  Handle open_dataset(std::string_view name) const {
    const std::string p(name);
    return h5::checked(H5Dopen2(file.get(), p.c_str(), H5P_DEFAULT), H5Dclose, path, "open dataset " + p);
  }
  std::vector<std::uint64_t> dims_of(hid_t set) const {
    const Handle space(H5Dget_space(set), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, rank)));
    if (rank > 0) H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
    return {extent.begin(), extent.end()};
  }
  std::size_t count_of(hid_t set) const {
    const Handle space(H5Dget_space(set), H5Sclose);
    const hssize_t n = H5Sget_simple_extent_npoints(space.get());
    if (n < 0) h5::fail(path, "read a dataset's shape");
    return static_cast<std::size_t>(n);
  }
  enum class Wanted { any_number, integer };
  template <class T>
  std::vector<T> read(std::string_view name, hid_t memory_type, Wanted wanted) const {
    const Handle set = open_dataset(name);
    const Handle type(H5Dget_type(set.get()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    const bool fits = kind == H5T_INTEGER || (wanted == Wanted::any_number && kind == H5T_FLOAT);
    // Converting silently from floats to integers would cut values.
    if (!fits)
      throw WorkError(path.string() + ": dataset " + std::string(name) + " is not of " + (wanted == Wanted::integer ? "whole numbers" : "numbers"));
    if (H5Tget_size(type.get()) > sizeof(T) && wanted == Wanted::integer)
      throw WorkError(path.string() + ": dataset " + std::string(name) + " has wider whole numbers than asked for");
    std::vector<T> out(count_of(set.get()));
    if (!out.empty())
      h5::check(H5Dread(set.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), path, "read dataset " + std::string(name));
    return out;
  }
  Handle open_attribute(std::string_view object, std::string_view name) const {
    const std::string o(object), n(name);
    return h5::checked(H5Aopen_by_name(file.get(), o.c_str(), n.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, path,
                       "read attribute '" + n + "' of " + o);
  }
  std::string text(std::string_view object, std::string_view name) const {
    const Handle a = open_attribute(object, name);
    const Handle type(H5Aget_type(a.get()), H5Tclose);
    if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0)
      throw WorkError(path.string() + ": attribute '" + std::string(name) + "' of " + std::string(object) + " is not a fixed-length text");
    std::string value(H5Tget_size(type.get()), '\0');
    h5::check(H5Aread(a.get(), type.get(), value.data()), path, "read attribute '" + std::string(name) + "'");
    return trimmed(std::move(value));
  }
  double number(std::string_view object, std::string_view name) const {
    const Handle a = open_attribute(object, name);
    const Handle space(H5Aget_space(a.get()), H5Sclose);
    double value = 0;
    if (H5Sget_simple_extent_npoints(space.get()) != 1)
      throw WorkError(path.string() + ": attribute '" + std::string(name) + "' of " + std::string(object) + " is not one number");
    h5::check(H5Aread(a.get(), H5T_NATIVE_DOUBLE, &value), path, "read attribute '" + std::string(name) + "' as a number");
    return value;
  }
};

H5Reader::H5Reader(const fs::path& path, std::string_view filetype, int format_version) : impl_(std::make_unique<Impl>()) {
  h5::silence_error_stack();
  impl_->path = path;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw WorkError(path.string() + ": no such file");
  if (H5Fis_hdf5(path.c_str()) <= 0) throw WorkError(path.string() + ": is not an HDF5 file");
  impl_->file = h5::checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path, "open");
  const std::string is_type = H5Aexists(impl_->file.get(), "filetype") > 0 ? impl_->text("/", "filetype") : "";
  if (is_type != filetype) throw WorkError(path.string() + ": is a '" + is_type + "' file, expected '" + std::string(filetype) + "'");
  const double version = impl_->number("/", "format_version");
  if (version != format_version)
    throw WorkError(path.string() + ": has format version " + std::to_string(static_cast<int>(version)) + " of '" + is_type +
                    "', this program reads " + std::to_string(format_version));
}
H5Reader::~H5Reader() = default;

bool H5Reader::has(std::string_view name) const {
  const std::string path(name);
  for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1))
    if (H5Lexists(impl_->file.get(), path.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(impl_->file.get(), path.c_str(), H5P_DEFAULT) > 0;
}
std::vector<std::uint64_t> H5Reader::dims(std::string_view name) const { return impl_->dims_of(impl_->open_dataset(name).get()); }
H5Meta H5Reader::meta(std::string_view name) const {
  impl_->open_dataset(name);  // a missing dataset is named as such, not as a missing attribute
  return {impl_->text(name, "units"), impl_->text(name, "axes"), impl_->text(name, "frame"), impl_->text(name, "description")};
}
std::string H5Reader::text_attribute(std::string_view object, std::string_view name) const { return impl_->text(object, name); }
double H5Reader::number_attribute(std::string_view object, std::string_view name) const { return impl_->number(object, name); }
std::vector<double> H5Reader::doubles(std::string_view name) const { return impl_->read<double>(name, H5T_NATIVE_DOUBLE, Impl::Wanted::any_number); }
std::vector<float> H5Reader::floats(std::string_view name) const { return impl_->read<float>(name, H5T_NATIVE_FLOAT, Impl::Wanted::any_number); }
std::vector<std::int64_t> H5Reader::integers(std::string_view name) const {
  return impl_->read<std::int64_t>(name, H5T_NATIVE_INT64, Impl::Wanted::integer);
}
std::vector<std::uint8_t> H5Reader::bytes(std::string_view name) const {
  return impl_->read<std::uint8_t>(name, H5T_NATIVE_UINT8, Impl::Wanted::integer);
}

std::vector<std::string> H5Reader::strings(std::string_view name) const {
  const Handle set = impl_->open_dataset(name);
  const Handle type(H5Dget_type(set.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0)
    throw WorkError(impl_->path.string() + ": dataset " + std::string(name) + " is not of fixed-length texts");
  const std::size_t length = H5Tget_size(type.get()), count = impl_->count_of(set.get());
  std::string packed(length * count, '\0');
  if (count > 0)
    h5::check(H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, packed.data()), impl_->path, "read dataset " + std::string(name));
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(trimmed(packed.substr(i * length, length)));
  return out;
}

std::vector<std::string> H5Reader::dataset_names() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* out) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(out)->push_back(std::string("/") + name);
    return 0;
  };
  h5::check(H5Ovisit2(impl_->file.get(), H5_INDEX_NAME, H5_ITER_INC, visit, &names, H5O_INFO_BASIC), impl_->path, "list the datasets");
  std::sort(names.begin(), names.end());
  return names;
}
}  // namespace venato
