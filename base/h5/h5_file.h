#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace venato {

/// What every dataset carries as attributes of the same names.
struct H5Meta {
  std::string units;        ///< "kg/m2", "1", …
  std::string axes;         ///< "y,x,zeta": slowest first
  std::string frame;        ///< design | belt | green | print | fired | dem | none
  std::string description;  ///< one sentence
};

/// Writes one HDF5 file at once; close() renames it to its final name (base/io/atomic_file.h). No time stamps inside: same data, same bytes.
/// Groups in names ("/slab/phi") are made as needed. \throws WorkError with the path on any failure.
class H5Writer {
 public:
  H5Writer(std::filesystem::path final_path, std::string_view filetype, int format_version);
  ~H5Writer();  ///< without close(): the partial file is removed
  H5Writer(const H5Writer&) = delete;
  H5Writer& operator=(const H5Writer&) = delete;
  void attribute(std::string_view object, std::string_view name, std::string_view value);  ///< object "/" = root
  void attribute(std::string_view object, std::string_view name, double value);
  void dataset(std::string_view name, std::span<const double> data, std::vector<std::uint64_t> dims, const H5Meta& meta);
  void dataset(std::string_view name, std::span<const float> data, std::vector<std::uint64_t> dims, const H5Meta& meta);
  void dataset(std::string_view name, std::span<const std::int64_t> data, std::vector<std::uint64_t> dims, const H5Meta& meta);
  void dataset(std::string_view name, std::span<const std::int32_t> data, std::vector<std::uint64_t> dims, const H5Meta& meta);
  void dataset(std::string_view name, std::span<const std::uint8_t> data, std::vector<std::uint64_t> dims, const H5Meta& meta);
  void strings(std::string_view name, const std::vector<std::string>& data, const H5Meta& meta);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// \throws WorkError (missing dataset, other type or shape, other filetype or format_version, not an HDF5 file).
class H5Reader {
 public:
  H5Reader(const std::filesystem::path& path, std::string_view filetype, int format_version);
  ~H5Reader();
  H5Reader(const H5Reader&) = delete;
  H5Reader& operator=(const H5Reader&) = delete;
  bool has(std::string_view name) const;
  std::vector<std::uint64_t> dims(std::string_view name) const;
  H5Meta meta(std::string_view name) const;
  std::string text_attribute(std::string_view object, std::string_view name) const;
  double number_attribute(std::string_view object, std::string_view name) const;
  std::vector<double> doubles(std::string_view name) const;  ///< any numeric type, converted
  std::vector<float> floats(std::string_view name) const;
  std::vector<std::int64_t> integers(std::string_view name) const;
  std::vector<std::uint8_t> bytes(std::string_view name) const;
  std::vector<std::string> strings(std::string_view name) const;
  std::vector<std::string> dataset_names() const;  ///< all datasets in the file, sorted, full paths

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace venato
