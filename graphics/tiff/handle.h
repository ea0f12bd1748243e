#pragma once
/// libtiff handles with their messages caught. Internal to graphics/tiff; the type is only declared so that tiffio.h stays in *_tiff.cpp.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "graphics/tiff/deflate.h"
#include "graphics/tiff/tiff_file.h"
struct tiff;
namespace venato::graphics::detail {

/// First error of a handle; libtiff prints nothing itself. Other warnings (unknown private tags …) do not concern the user.
struct TiffLog {
  std::string first_error;
  std::string cut_tag;  ///< a tag whose value lies beyond the end of the file
  std::string reason(std::string_view fallback) const { return first_error.empty() ? std::string(fallback) : first_error; }
};
struct CloseTiff {
  void operator()(tiff* t) const;
};
using TiffHandle = std::unique_ptr<tiff, CloseTiff>;

/// \throws UsageError when the file is missing, empty or not a TIFF. `log` must outlive the handle.
TiffHandle open_tiff_reader(const std::filesystem::path& file, TiffLog& log);
/// Takes over the descriptor. \return null on failure
TiffHandle open_tiff_writer(int descriptor, const std::string& name, bool big_tiff, TiffLog& log);

int bytes_per_sample(const TiffInfo& info);
/// Size and coding tags that decide how a strip is compressed (`height` of the file, or of the one strip).
void set_coding_tags(tiff* t, const TiffInfo& info, std::int64_t height);
/// Everything else: inks, polarity, resolution, texts.
void set_description_tags(tiff* t, const TiffInfo& info);

/// Compresses one strip on its own, in memory: 8 bit deflate by libdeflate, everything else exactly as libtiff would inside a file. One object per
/// thread; keeps its buffers.
class StripEncoder {
 public:
  /// \param rows whole rows of the strip \return bytes valid until the next call. \throws WorkError
  std::span<const std::uint8_t> encode(const TiffInfo& info, std::span<const std::uint8_t> rows);

 private:
  std::vector<std::uint8_t> memory_;
  DeflateStrip deflate_;
};
}  // namespace venato::graphics::detail
