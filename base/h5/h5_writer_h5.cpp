#include <algorithm>
#include <limits>
#include <system_error>

#include "base/error.h"
#include "base/expects.h"
#include "base/h5/h5_file.h"
#include "base/h5/h5_handle_h5.h"
#include "base/io/atomic_file.h"

namespace venato {
namespace fs = std::filesystem;
using h5::Handle;
namespace {
constexpr std::size_t kContiguousBytes = 64u << 10;  ///< smaller datasets: compression costs more than it saves
constexpr std::size_t kChunkBytes = 1u << 20;        ///< HDF5's default chunk cache holds one
constexpr unsigned kDeflateLevel = 4;

std::size_t count_of(const std::vector<std::uint64_t>& dims) {
  std::size_t n = 1;
  for (const std::uint64_t d : dims) n *= d;
  return n;
}

/// Slowest axes are cut first, so that a chunk is a run of neighbouring values.
std::vector<hsize_t> chunk_of(const std::vector<std::uint64_t>& dims, std::size_t item_bytes) {
  std::vector<hsize_t> chunk(dims.begin(), dims.end());
  std::size_t bytes = item_bytes * count_of(dims);
  for (std::size_t axis = 0; axis < chunk.size() && bytes > kChunkBytes; ++axis) {
    const std::size_t row = bytes / chunk[axis];
    chunk[axis] = std::max<hsize_t>(1, kChunkBytes / std::max<std::size_t>(1, row));
    bytes = row * chunk[axis];
  }
  return chunk;
}
}  // namespace

struct H5Writer::Impl {
  fs::path final_path, partial;
  Handle file;

  Handle make_file() const {
    h5::silence_error_stack();
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    h5::check(H5Pset_obj_track_times(creation.get(), false), final_path, "switch off time stamps");
    // One fixed format: the bytes do not depend on the library's idea of "latest", and HDF5 1.8 readers (MATLAB) open it.
    h5::check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_V18), final_path, "fix the file format");
    return h5::checked(H5Fcreate(partial.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose, final_path, "create");
  }
  /// Opens the object; groups on the way (and itself, when it does not exist) are made.
  Handle open_object(std::string_view name) const {
    const std::string path(name);
    if (path != "/" && !exists(path)) make_groups(path + "/x");
    return h5::checked(H5Oopen(file.get(), path.c_str(), H5P_DEFAULT), H5Oclose, final_path, "open " + path);
  }
  bool exists(const std::string& path) const {
    for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1))
      if (H5Lexists(file.get(), path.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(file.get(), path.c_str(), H5P_DEFAULT) > 0;
  }
  void make_groups(const std::string& path) const {
    const Handle plain(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(plain.get(), false);
    for (std::size_t at = path.find('/', 1); at != std::string::npos; at = path.find('/', at + 1)) {
      const std::string group = path.substr(0, at);
      if (H5Lexists(file.get(), group.c_str(), H5P_DEFAULT) > 0) continue;
      h5::checked(H5Gcreate2(file.get(), group.c_str(), H5P_DEFAULT, plain.get(), H5P_DEFAULT), H5Gclose, final_path, "create group " + group);
    }
  }
  void write_attribute(hid_t object, const std::string& name, hid_t type, const void* value) const {
    const std::string doing = "write attribute '" + name + "'";
    if (H5Aexists(object, name.c_str()) > 0) h5::check(H5Adelete(object, name.c_str()), final_path, doing);
    const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle a = h5::checked(H5Acreate2(object, name.c_str(), type, scalar.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, final_path, doing);
    h5::check(H5Awrite(a.get(), type, value), final_path, doing);
  }
  void write_text(hid_t object, const std::string& name, std::string_view text) const {
    const std::string terminated(text);  // an empty view may have no address to read one byte from
    write_attribute(object, name, h5::text_type(text.size()).get(), terminated.c_str());
  }
  void write_dataset(std::string_view name, hid_t type, std::size_t item_bytes, std::size_t count, const void* data,
                     const std::vector<std::uint64_t>& dims, const H5Meta& meta) const {
    VENATO_EXPECTS(!name.empty() && name.front() == '/' && name.back() != '/');
    VENATO_EXPECTS(count == count_of(dims));
    const std::string path(name), doing = "write dataset " + path;
    make_groups(path);
    const std::vector<hsize_t> extent(dims.begin(), dims.end());
    const Handle space = dims.empty()
                             ? Handle(H5Screate(H5S_SCALAR), H5Sclose)
                             : h5::checked(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose, final_path, doing);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.get(), false);
    if (item_bytes * count > kContiguousBytes && !dims.empty()) {
      const auto chunk = chunk_of(dims, item_bytes);
      h5::check(H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()), final_path, doing);
      h5::check(H5Pset_shuffle(creation.get()), final_path, doing);
      h5::check(H5Pset_deflate(creation.get(), kDeflateLevel), final_path, doing);
    }
    const Handle set =
        h5::checked(H5Dcreate2(file.get(), path.c_str(), type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Dclose, final_path, doing);
    if (count > 0) h5::check(H5Dwrite(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), final_path, doing);
    write_text(set.get(), "units", meta.units);
    write_text(set.get(), "axes", meta.axes);
    write_text(set.get(), "frame", meta.frame);
    write_text(set.get(), "description", meta.description);
  }
};

H5Writer::H5Writer(fs::path final_path, std::string_view filetype, int format_version) : impl_(std::make_unique<Impl>()) {
  impl_->final_path = std::move(final_path);
  impl_->partial = partial_path(impl_->final_path);
  impl_->file = impl_->make_file();
  attribute("/", "filetype", filetype);
  const Handle root = impl_->open_object("/");
  impl_->write_attribute(root.get(), "format_version", H5T_NATIVE_INT, &format_version);
}

H5Writer::~H5Writer() {
  if (!impl_->file.valid()) return;
  impl_->file.reset();
  std::error_code ignored;  // a destructor cannot report; the partial name says what the file is
  fs::remove(impl_->partial, ignored);
}

void H5Writer::attribute(std::string_view object, std::string_view name, std::string_view value) {
  impl_->write_text(impl_->open_object(object).get(), std::string(name), value);
}
void H5Writer::attribute(std::string_view object, std::string_view name, double value) {
  impl_->write_attribute(impl_->open_object(object).get(), std::string(name), H5T_NATIVE_DOUBLE, &value);
}
void H5Writer::dataset(std::string_view name, std::span<const double> data, std::vector<std::uint64_t> dims, const H5Meta& meta) {
  impl_->write_dataset(name, H5T_NATIVE_DOUBLE, sizeof(double), data.size(), data.data(), dims, meta);
}
void H5Writer::dataset(std::string_view name, std::span<const float> data, std::vector<std::uint64_t> dims, const H5Meta& meta) {
  impl_->write_dataset(name, H5T_NATIVE_FLOAT, sizeof(float), data.size(), data.data(), dims, meta);
}
void H5Writer::dataset(std::string_view name, std::span<const std::int64_t> data, std::vector<std::uint64_t> dims, const H5Meta& meta) {
  impl_->write_dataset(name, H5T_NATIVE_INT64, sizeof(std::int64_t), data.size(), data.data(), dims, meta);
}
void H5Writer::dataset(std::string_view name, std::span<const std::int32_t> data, std::vector<std::uint64_t> dims, const H5Meta& meta) {
  impl_->write_dataset(name, H5T_NATIVE_INT32, sizeof(std::int32_t), data.size(), data.data(), dims, meta);
}
void H5Writer::dataset(std::string_view name, std::span<const std::uint8_t> data, std::vector<std::uint64_t> dims, const H5Meta& meta) {
  impl_->write_dataset(name, H5T_NATIVE_UINT8, sizeof(std::uint8_t), data.size(), data.data(), dims, meta);
}

void H5Writer::strings(std::string_view name, const std::vector<std::string>& data, const H5Meta& meta) {
  std::size_t length = 1;
  for (const std::string& s : data) length = std::max(length, s.size());
  std::string packed(length * data.size(), '\0');
  for (std::size_t i = 0; i < data.size(); ++i) std::copy(data[i].begin(), data[i].end(), packed.begin() + static_cast<std::ptrdiff_t>(i * length));
  impl_->write_dataset(name, h5::text_type(length).get(), length, data.size(), packed.data(), {data.size()}, meta);
}

void H5Writer::close() {
  VENATO_EXPECTS(impl_->file.valid());
  // A full disk may show only here, when the library flushes. A failed flush leaves the file for the destructor to remove.
  h5::check(H5Fflush(impl_->file.get(), H5F_SCOPE_GLOBAL), impl_->final_path, "write to disk");
  if (impl_->file.reset() < 0) {
    std::error_code ignored;
    fs::remove(impl_->partial, ignored);
    h5::fail(impl_->final_path, "close");
  }
  try {
    commit_partial(impl_->partial, impl_->final_path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(impl_->partial, ignored);
    throw;
  }
}
}  // namespace venato
