#include "sync/warp/warp.h"

#include <array>
#include <cmath>
#include <utility>

#include "graphics/raster/resample.h"
#include "sync/warp/bilinear.h"
#include "sync/warp/row_cubics.h"

namespace venato::sync {
namespace {

using detail::kWeightBits;
using detail::kWeightOne;

constexpr int kChunk = 256;             ///< columns whose positions are computed together: 2 kB, stays in the first-level cache
constexpr int kMaxSourceSide = 100000;  ///< positions in 17.14 fixed point must fit 31 bits
constexpr double kGuardPx = 4;          ///< positions are clamped this far outside, so that the conversion to int is always defined

struct Extent {
  std::ptrdiff_t width, height;
};

/// Positions of `count` pixels from number `begin` of a run, as 17.14 fixed point.
void fixed_positions(const std::array<double, 4>& c, double t0, double dt, int begin, int count, double side_px, std::int32_t* q) {
  const double low = -kGuardPx, high = side_px + kGuardPx;
  for (int k = 0; k < count; ++k) {
    const double t = t0 + static_cast<double>(begin + k) * dt;
    double s = ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
    s = s > low ? s : low;  // also sends NaN outside
    s = s < high ? s : high;
    // Biased positive so that truncation rounds to nearest for negative positions too.
    q[k] = static_cast<std::int32_t>((s + 2 * kGuardPx) * kWeightOne + 0.5) - static_cast<std::int32_t>(2 * kGuardPx) * kWeightOne;
  }
}

/// First pixel and weight of the second one along an axis of `side` pixels; false = more than one pixel outside.
inline bool axis_tap(std::int32_t q, std::ptrdiff_t side, std::ptrdiff_t& first, int& weight) {
  const std::int32_t one_half = kWeightOne / 2, last = static_cast<std::int32_t>(side - 1) * kWeightOne;
  if (q < -(kWeightOne + one_half) || q > last + kWeightOne + one_half) return false;
  const std::int32_t inside = q < 0 ? 0 : (q > last ? last : q);
  const auto pair = static_cast<std::int32_t>(side > 1 ? side - 2 : 0);
  std::int32_t k = inside >> kWeightBits;
  k = k > pair ? pair : k;
  first = k;
  weight = inside - (k << kWeightBits);
  return true;
}

template <int N>
void warp_run(const graphics::Raster8& source, const std::int32_t* qx, const std::int32_t* qy, int count, std::uint8_t* out,
              const std::uint8_t* row_end, std::uint8_t outside) {
  const Extent size{source.width, source.height};
  const std::ptrdiff_t stride = size.width * N;
  const std::uint8_t* data = source.data.data();
  [[maybe_unused]] const std::uint8_t* data_end = data + source.data.size();
  detail::Tap tap{};
  tap.right = size.width > 1 ? N : 0;
  tap.down = size.height > 1 ? stride : 0;
  for (int k = 0; k < count; ++k, out += N) {
    std::ptrdiff_t x = 0, y = 0;
    if (!axis_tap(qx[k], size.width, x, tap.wx) || !axis_tap(qy[k], size.height, y, tap.wy)) {
      std::memset(out, outside, N);
      continue;
    }
    tap.upper = data + y * stride + x * N;
#if defined(__SSE2__)
    if (N <= detail::kVectorBytes && data_end - tap.upper >= tap.down + tap.right + detail::kVectorBytes && row_end - out >= detail::kVectorBytes) {
      detail::blend_sse2(tap, out);
      continue;
    }
#endif
    detail::blend_scalar<N>(tap, out);
  }
}

template <int N>
void warp_row(const graphics::Raster8& source, const Transform& source_from_green, const WarpGrid& grid, std::int64_t row, std::uint8_t* out,
              std::uint8_t outside) {
  const std::uint8_t* row_end = out + grid.width * N;
  std::array<std::int32_t, kChunk> qx, qy;
  for (const RowCubic& run : row_cubics(source_from_green, source.pitch_m, grid, row)) {
    for (std::int64_t begin = 0; begin < run.count; begin += kChunk) {
      const int count = static_cast<int>(std::min<std::int64_t>(kChunk, run.count - begin));
      fixed_positions(run.x, run.t0, run.dt, static_cast<int>(begin), count, source.width, qx.data());
      fixed_positions(run.y, run.t0, run.dt, static_cast<int>(begin), count, source.height, qy.data());
      warp_run<N>(source, qx.data(), qy.data(), count, out + (run.first + begin) * N, row_end, outside);
    }
  }
}

using WarpRow = void (*)(const graphics::Raster8&, const Transform&, const WarpGrid&, std::int64_t, std::uint8_t*, std::uint8_t);
template <int... N>
constexpr std::array<WarpRow, sizeof...(N)> warp_row_table(std::integer_sequence<int, N...>) {
  return {warp_row<N + 1>...};
}
constexpr auto kWarpRow = warp_row_table(std::make_integer_sequence<int, kMaxWarpChannels>{});

}  // namespace

void warp_rows(const graphics::Raster8& source, const Transform& source_from_green, const WarpGrid& grid, std::int64_t first_row, int rows,
               std::span<std::uint8_t> out, int threads, std::uint8_t outside) {
  VENATO_EXPECTS(source.channels >= 1 && source.channels <= kMaxWarpChannels);
  VENATO_EXPECTS(source.width >= 1 && source.height >= 1 && source.width <= kMaxSourceSide && source.height <= kMaxSourceSide);
  VENATO_EXPECTS(source.pitch_m > 0 && grid.pitch_m > 0 && grid.width > 0);
  VENATO_EXPECTS(first_row >= 0 && rows >= 0 && first_row + rows <= grid.height);
  const auto row_bytes = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(source.channels);
  VENATO_EXPECTS(out.size() == row_bytes * static_cast<std::size_t>(rows));
  const WarpRow warp = kWarpRow[static_cast<std::size_t>(source.channels - 1)];
#pragma omp parallel for schedule(dynamic, 8) num_threads(threads) if (threads > 1)
  for (int r = 0; r < rows; ++r) warp(source, source_from_green, grid, first_row + r, out.data() + static_cast<std::size_t>(r) * row_bytes, outside);
}

graphics::Raster8 reduced_if_finer(const graphics::Raster8& source, double pitch_m) {
  const int k = static_cast<int>(std::floor(pitch_m / source.pitch_m + 1e-6));  // 1e-6: a ratio of 2 that rounding made 1.9999999 is 2
  return k < 2 ? graphics::Raster8{} : graphics::shrink(source, k);
}

}  // namespace venato::sync
