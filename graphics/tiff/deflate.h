#pragma once
/// Deflate strips with the horizontal predictor, by libdeflate: about twice zlib's rate at the same size. Internal to graphics/tiff.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
struct libdeflate_compressor;
namespace venato::graphics::detail {

/// One object per thread; keeps its buffers and its compressor.
class DeflateStrip {
 public:
  DeflateStrip();
  ~DeflateStrip();
  DeflateStrip(DeflateStrip&&) noexcept;
  /// \param rows whole rows of 8 bit samples, `row_bytes` each; \param channels distance of the samples that are subtracted from each other
  /// (TIFF 6.0 section 14: Predictor 2) \return a zlib stream (Compression 8), valid until the next call; the same bytes on every machine with
  /// the same libdeflate. \throws WorkError
  std::span<const std::uint8_t> encode(std::span<const std::uint8_t> rows, std::size_t row_bytes, std::size_t channels);

 private:
  struct Free {
    void operator()(libdeflate_compressor* c) const;
  };
  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  std::vector<std::uint8_t> differences_, coded_;
};
}  // namespace venato::graphics::detail
