#pragma once
/// N-channel TIFF by strips, on libtiff (kept in its own .cpp: tiffio.h and OpenCV headers clash).
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
namespace venato::graphics {

enum class TiffCompression { none, packbits, lzw, deflate };
enum class TiffKind { grey, rgb, separated, fractions_f32 };  ///< photometric: MinIsBlack, RGB, 5 + InkSet 2, MinIsBlack float
struct TiffInfo {
  std::int64_t width = 0, height = 0;
  int channels = 1;
  TiffKind kind = TiffKind::grey;
  double dpi = 0;
  TiffCompression compression = TiffCompression::deflate;
  int rows_per_strip = 64;
  std::vector<std::string> ink_names;  ///< separated: one per channel
  std::string description, software;   ///< ImageDescription: one line JSON; Software ("" = "venato"); no DateTime (reproducible bytes)
  std::string icc_profile;             ///< tag 34675: the bytes of an ICC profile of these channels; "" = none. Not filled by read_tiff_info
  bool big_tiff = false;
  std::uint8_t no_ink_value = 0;  ///< polarity, told by DotRange and the sidecar
  int bits = 8;                   ///< of a sample; set by read_tiff_info (writers follow `kind`: 8, or 32 for fractions_f32)
};

/// Strip writer: rows top to bottom in any chunk; strips are compressed in parallel (threads) in memory and written in order: same bytes for
/// any thread count and chunk height. Written under a partial name; close() fsyncs and renames; without close() nothing stays behind.
/// Deflate of 8 bit samples is libdeflate's level 1 (tests/bench/RESULTS.md). libtiff's coders on 6 inks at 360 dpi, MB/s of samples per core, smooth
/// / with dither noise: LZW 260 / 120 (19 : 1 / 3.2 : 1), packbits 560 / 370 (2.1 : 1 / 1.8 : 1). Classic TIFF ends at 4 GiB: set big_tiff above.
/// \throws WorkError naming the path (disk full, permission, more than 4 GiB without big_tiff).
class TiffStripWriter {
 public:
  TiffStripWriter(std::filesystem::path final_path, const TiffInfo& info, int threads);
  ~TiffStripWriter();
  void write_rows(std::span<const std::uint8_t> rows);  ///< whole rows, width*channels*bytes each
  /// The next strip as StripCoder made it from `rows` rows (rows_per_strip, or what the last strip has). Not together with write_rows.
  void write_coded(std::span<const std::uint8_t> strip, int rows);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
/// Compresses strips outside the writer, for callers that make many files of one pass: one object per thread, it keeps its buffers.
class StripCoder {
 public:
  StripCoder();
  ~StripCoder();
  StripCoder(StripCoder&&) noexcept;
  /// \param info of the file \param rows whole rows of one strip \return bytes for write_coded, valid until the next call. \throws WorkError
  std::span<const std::uint8_t> encode(const TiffInfo& info, std::span<const std::uint8_t> rows);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
/// Header only; refuses sizes beyond limits before allocating. dpi is 0 when the file has none or its pixels are not square.
/// \throws UsageError naming file and reason.
TiffInfo read_tiff_info(const std::filesystem::path& file);
/// Whole file, raw sample values (no polarity, alpha or orientation applied), any channel count; strips or tiles, interleaved or planar.
/// pitch_m is 0 when the file has no dpi. Refused before anything large is allocated: more than max_bytes of samples, data beyond the
/// end of the file, more pixels than the compressed data could hold. \throws UsageError naming file and reason.
Raster8 read_tiff8(const std::filesystem::path& file, double max_bytes = 4e9);
RasterF read_tiff_f32(const std::filesystem::path& file, double max_bytes = 4e9);
/// Whole raster at once; width, height, channels come from the image, and dpi from its pitch when info.dpi is 0.
void write_tiff(const std::filesystem::path& file, const Raster8& image, TiffInfo info, int threads);
void write_tiff(const std::filesystem::path& file, const RasterF& image, TiffInfo info, int threads);
}  // namespace venato::graphics
