#include "dem/neighbours/near_scan.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/neighbours/near_scan.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace venato::dem::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

std::size_t near_scan(const NearField& field, std::int32_t i, const std::vector<std::pair<std::int32_t, std::int32_t>>& runs, std::int32_t* out) {
  const hn::CappedTag<float, 8> d;  // runs are short
  using V = hn::Vec<decltype(d)>;
  constexpr std::int32_t kWide = static_cast<std::int32_t>(hn::MaxLanes(d));
  const NearGrain& here = field.grain[static_cast<std::size_t>(i)];
  const V x = hn::Set(d, here.x), y = hn::Set(d, here.y), z = hn::Set(d, here.z), reach = hn::Set(d, here.reach);
  const bool periodic = field.length[0] > 0 || field.length[1] > 0 || field.length[2] > 0;
  auto apart = [&](V a, V b, int axis) HWY_ATTR {
    const V raw = hn::Sub(a, b);
    return periodic ? hn::Sub(raw, hn::Mul(hn::Set(d, field.length[axis]), hn::Round(hn::Mul(raw, hn::Set(d, field.inverse_length[axis]))))) : raw;
  };
  std::size_t n = 0;
  for (const auto& [from, to] : runs)
    for (std::int32_t k = from; k < to; k += kWide) {
      V gx, gy, gz, gr;
      hn::LoadInterleaved4(d, &field.grain[static_cast<std::size_t>(k)].x, gx, gy, gz, gr);
      const V dx = apart(gx, x, 0), dy = apart(gy, y, 1), dz = apart(gz, z, 2), far = hn::Add(gr, reach);
      const V d2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      std::uint8_t mask[8] = {};
      hn::StoreMaskBits(d, hn::Lt(d2, hn::Mul(far, far)), mask);
      std::uint32_t bits = mask[0];
      if (to - k < kWide) bits &= (1u << (to - k)) - 1;
      if (i >= k && i < k + kWide) bits &= ~(1u << (i - k));
      for (; bits != 0; bits &= bits - 1) out[n++] = k + __builtin_ctz(bits);
    }
  return n;
}
}  // namespace venato::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace venato::dem {
HWY_EXPORT(near_scan);
std::size_t near_scan(const NearField& field, std::int32_t i, const std::vector<std::pair<std::int32_t, std::int32_t>>& runs, std::int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(near_scan)(field, i, runs, out);
}

NearField make_near_field(std::span<const Sphere> spheres, std::span<const double> reach, std::span<const std::int32_t> slots,
                          const PeriodicBox& box, int threads) {
  constexpr double kRounding = 1e-6;  // of the largest coordinate: ten roundings of single precision
  constexpr std::size_t kPadding = 8;
  NearField field;
  field.grain.assign(spheres.size() + kPadding, NearGrain{0, 0, 0, 0});
  if (spheres.empty()) return field;
  const Sphere origin = spheres.front();
  double extent = 0;
  for (std::size_t a = 0; a < 3; ++a)
    if (box.length[a] > 0) {
      field.length[a] = static_cast<float>(box.length[a]), field.inverse_length[a] = static_cast<float>(1 / box.length[a]);
      extent = std::max(extent, box.length[a]);
    }
  const std::int64_t n = static_cast<std::int64_t>(spheres.size());
  field.place.resize(slots.size());
#pragma omp parallel for schedule(static) reduction(max : extent) num_threads(threads) if (threads > 1)
  for (std::int64_t k = 0; k < n; ++k) {
    const Sphere& s = spheres[static_cast<std::size_t>(k)];
    const double d[3] = {std::abs(s.x - origin.x), std::abs(s.y - origin.y), std::abs(s.z - origin.z)};
    for (const double v : d)
      if (v < 1e6) extent = std::max(extent, v);  // not of a grain that blew up
  }
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (std::int64_t k = 0; k < n; ++k) {
    const std::size_t slot = static_cast<std::size_t>(slots.empty() ? static_cast<std::int32_t>(k) : slots[static_cast<std::size_t>(k)]);
    const Sphere& s = spheres[slot];
    field.grain[static_cast<std::size_t>(k)] = {static_cast<float>(s.x - origin.x), static_cast<float>(s.y - origin.y),
                                                static_cast<float>(s.z - origin.z), static_cast<float>(reach[slot] + kRounding * extent)};
    if (!slots.empty()) field.place[slot] = static_cast<std::int32_t>(k);
  }
  return field;
}
}  // namespace venato::dem
#endif
