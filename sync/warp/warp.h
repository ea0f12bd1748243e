#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// Pixel grid of a print file in the green frame: pixel (i, j) is centred on ((i + 1/2) pitch, (j + 1/2) pitch).
struct WarpGrid {
  std::int64_t width = 0, height = 0;
  double pitch_m = 0;
};

inline constexpr int kMaxWarpChannels = 15;  ///< as many as an ICC profile has inks

/// Rows [first_row, first_row + rows) of   out(p) = source(source_from_green(p)),   all channels at once, bilinear.
/// \param source  8 bit, interleaved, 1..15 channels (up to 8 in vector code), own pitch, at most 100 000 px per side; contone (never warp screened
/// data) \param source_from_green  [m] -> [m]; its B-spline is a cubic of x between knots, so every row is evaluated exactly (to rounding), without
/// maps \param out     rows * grid.width * channels bytes \param outside value where the source has nothing; up to 1 source pixel beyond its border
/// the border's own value is used Arithmetic: positions rounded to 2^-14 px, integer weights, one rounding of the horizontal blend to 1/128 level:
/// within 1 level of the real-valued result, constants and identity exact. A pixel depends on its own row and column only: the same bytes for any
/// strip height and thread count. Validity: bilinear sampling does not average; when the source is finer than the grid call reduced_if_finer first.
void warp_rows(const graphics::Raster8& source, const Transform& source_from_green, const WarpGrid& grid, std::int64_t first_row, int rows,
               std::span<std::uint8_t> out, int threads, std::uint8_t outside = 0);

/// Source positions [px, pixel centres at integers] of the pixels of one output row, as the kernel uses them before rounding to 2^-14 px.
struct RowPositions {
  std::vector<double> x, y;
};
RowPositions source_positions(const Transform& source_from_green, double source_pitch_m, const WarpGrid& grid, std::int64_t row);

/// Box average over k x k pixels, k = floor(pitch / source pitch), when k >= 2; otherwise an empty raster: the source is good as it is.
/// The last row and column average what is there.
graphics::Raster8 reduced_if_finer(const graphics::Raster8& source, double pitch_m);
}  // namespace venato::sync
