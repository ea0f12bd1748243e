#include "dem/simulation/pair_lanes.h"

#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/simulation/pair_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace venato::dem::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
static_assert(kLanes == 1 || kLanes == 2 || kLanes == 4 || kLanes == 8, "fixed-size vectors only");

// Rows (one grain's or contact's numbers side by side) to lanes (one number of kLanes rows side by side) and back. Whole rows are loaded and stored,
// turning happens in registers.
#if HWY_TARGET == HWY_SCALAR  // a CPU without SSSE3: one lane, nothing to turn
HWY_INLINE void load_rows4(const double* const* row, V* c) {
  for (int k = 0; k < 4; ++k) c[k] = hn::LoadU(D(), row[0] + k);
}
HWY_INLINE void load_rows8(const double* const* row, V* c) {
  for (int k = 0; k < 8; ++k) c[k] = hn::LoadU(D(), row[0] + k);
}
HWY_INLINE void store_rows8(const V* c, double* const* row) {
  for (int k = 0; k < 8; ++k) hn::StoreU(c[k], D(), row[0] + k);
}
HWY_INLINE void load_rows6(const double* const* row, V* c) {
  for (int k = 0; k < 6; ++k) c[k] = hn::LoadU(D(), row[0] + k);
}
HWY_INLINE void store_rows6(const V* c, double* const* row) {
  for (int k = 0; k < 6; ++k) hn::StoreU(c[k], D(), row[0] + k);
}
#else
/// Turns 2 x 2 numbers inside every 128-bit block.
HWY_INLINE void turn2(V& a, V& b) {
  const V low = hn::InterleaveLower(D(), a, b), high = hn::InterleaveUpper(D(), a, b);
  a = low, b = high;
}
#if HWY_MAX_BYTES == 16
constexpr int kSquare = 2;  // rows that are turned together
HWY_INLINE void turn(V* v) { turn2(v[0], v[1]); }
#else
/// Turns 2 x 2 neighbouring blocks: [a0 a1 …], [b0 b1 …] -> [a0 b0 …], [a1 b1 …].
HWY_INLINE void turn_blocks(V& a, V& b) {
#if HWY_MAX_BYTES == 32
  const V low = hn::ConcatLowerLower(D(), b, a), high = hn::ConcatUpperUpper(D(), b, a);
#else
  const V low = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a), high = hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
#endif
  a = low, b = high;
}
/// Turns 4 x 4 numbers in every 256 bits.
HWY_INLINE void turn4(V* v) {
  turn2(v[0], v[1]), turn2(v[2], v[3]);
  turn_blocks(v[0], v[2]), turn_blocks(v[1], v[3]);
}
#if HWY_MAX_BYTES == 32
constexpr int kSquare = 4;
HWY_INLINE void turn(V* v) { turn4(v); }
#else
constexpr int kSquare = 8;
HWY_INLINE void turn(V* v) {
  turn4(v), turn4(v + 4);
  for (int k = 0; k < 4; ++k) {
    const V low = hn::ConcatLowerLower(D(), v[k + 4], v[k]), high = hn::ConcatUpperUpper(D(), v[k + 4], v[k]);
    v[k] = low, v[k + 4] = high;
  }
}
#endif
#endif
HWY_INLINE void load_rows4(const double* const* row, V* c) {
#if HWY_MAX_BYTES == 64
  const hn::Half<D> half;
  for (int l = 0; l < 4; ++l) c[l] = hn::Combine(D(), hn::LoadU(half, row[l + 4]), hn::LoadU(half, row[l]));
  turn4(c);
#else
  for (int h = 0; h < 4; h += kSquare) {
    for (int l = 0; l < kSquare; ++l) c[h + l] = hn::LoadU(D(), row[l] + h);
    turn(c + h);
  }
#endif
}
HWY_INLINE void load_rows8(const double* const* row, V* c) {
  for (int h = 0; h < 8; h += kSquare) {
    for (int l = 0; l < kSquare; ++l) c[h + l] = hn::LoadU(D(), row[l] + h);
    turn(c + h);
  }
}
HWY_INLINE void store_rows8(const V* column, double* const* row) {
  V c[8];
  for (int k = 0; k < 8; ++k) c[k] = column[k];
  for (int h = 0; h < 8; h += kSquare) {
    turn(c + h);
    for (int l = 0; l < kSquare; ++l) hn::StoreU(c[h + l], D(), row[l] + h);
  }
}
/// Rows of six: four and two.
HWY_INLINE void load_rows6(const double* const* row, V* c) {
  load_rows4(row, c);
  const double* pair[kLanes];
  for (int l = 0; l < kLanes; ++l) pair[l] = row[l] + 4;
#if HWY_MAX_BYTES == 16
  for (int l = 0; l < 2; ++l) c[4 + l] = hn::LoadU(D(), pair[l]);
#elif HWY_MAX_BYTES == 32
  const hn::Half<D> two;
  for (int l = 0; l < 2; ++l) c[4 + l] = hn::Combine(D(), hn::LoadU(two, pair[l + 2]), hn::LoadU(two, pair[l]));
#else
  const hn::Half<D> four;
  const hn::Half<decltype(four)> two;
  for (int l = 0; l < 2; ++l)
    c[4 + l] = hn::Combine(D(), hn::Combine(four, hn::LoadU(two, pair[l + 6]), hn::LoadU(two, pair[l + 4])),
                           hn::Combine(four, hn::LoadU(two, pair[l + 2]), hn::LoadU(two, pair[l])));
#endif
  turn2(c[4], c[5]);
}
HWY_INLINE void store_rows6(const V* column, double* const* row) {
  V c[6];
  for (int k = 0; k < 6; ++k) c[k] = column[k];
  turn2(c[4], c[5]);
#if HWY_MAX_BYTES == 16
  for (int h = 0; h < 4; h += 2) {
    turn2(c[h], c[h + 1]);
    for (int l = 0; l < 2; ++l) hn::StoreU(c[h + l], D(), row[l] + h);
  }
  for (int l = 0; l < 2; ++l) hn::StoreU(c[4 + l], D(), row[l] + 4);
#else
  turn4(c);
  const hn::Half<D> half;
#if HWY_MAX_BYTES == 32
  for (int l = 0; l < 4; ++l) hn::StoreU(c[l], D(), row[l]);
  for (int l = 0; l < 2; ++l)
    hn::StoreU(hn::LowerHalf(half, c[4 + l]), half, row[l] + 4), hn::StoreU(hn::UpperHalf(half, c[4 + l]), half, row[l + 2] + 4);
#else
  for (int l = 0; l < 4; ++l) hn::StoreU(hn::LowerHalf(half, c[l]), half, row[l]), hn::StoreU(hn::UpperHalf(half, c[l]), half, row[l + 4]);
  const hn::Half<decltype(half)> two;
  for (int l = 0; l < 2; ++l) {
    const auto low = hn::LowerHalf(half, c[4 + l]), high = hn::UpperHalf(half, c[4 + l]);
    hn::StoreU(hn::LowerHalf(two, low), two, row[l] + 4), hn::StoreU(hn::UpperHalf(two, low), two, row[l + 2] + 4);
    hn::StoreU(hn::LowerHalf(two, high), two, row[l + 4] + 4), hn::StoreU(hn::UpperHalf(two, high), two, row[l + 6] + 4);
  }
#endif
#endif
}
#endif
HWY_INLINE V nearest(V x, double length, double inverse) {
  const D d;
  return hn::Sub(x, hn::Mul(hn::Set(d, length), hn::Round(hn::Mul(x, hn::Set(d, inverse)))));
}
/// Centres of j seen from i, and radii.
struct Apart {
  V x, y, z, ri, rj;
};
HWY_INLINE Apart apart(const PairView& v, const double* const* i, const double* const* j) {
  V a[4], b[4];
  load_rows4(i, a), load_rows4(j, b);
  Apart p{hn::Sub(b[0], a[0]), hn::Sub(b[1], a[1]), hn::Sub(b[2], a[2]), a[3], b[3]};
  if (v.periodic) {
    p.x = nearest(p.x, v.length[0], v.inverse_length[0]);
    p.y = nearest(p.y, v.length[1], v.inverse_length[1]);
    p.z = nearest(p.z, v.length[2], v.inverse_length[2]);
  }
  return p;
}

constexpr std::size_t kFetch = 48;  // pairs

void find_touching(const PairView& v, std::size_t from, std::size_t to, PairChunk& now, PairChunk& changed) {
  const D d;
  const auto* sphere = reinterpret_cast<const double*>(v.sphere);
  std::size_t n = 0;
  changed.count = 0;
  for (std::size_t p = from; p < to; p += 8) {
    std::uint32_t bits = 0;
    for (std::size_t k = p + kFetch; k < p + kFetch + 8; ++k) __builtin_prefetch(v.sphere + v.second(std::min(k, to - 1)));
    for (int g = 0; g < 8; g += kLanes) {
      const double *i[kLanes], *j[kLanes];
      for (int l = 0; l < kLanes; ++l) {
        const std::size_t q = p + static_cast<std::size_t>(g + l);
        i[l] = sphere + 4 * v.first(q), j[l] = sphere + 4 * v.second(q);
      }
      const Apart a = apart(v, i, j);
      const V d2 = hn::Add(hn::Add(hn::Mul(a.x, a.x), hn::Mul(a.y, a.y)), hn::Mul(a.z, a.z)), reach = hn::Add(a.ri, a.rj);
      std::uint8_t mask[8] = {};
      hn::StoreMaskBits(d, hn::Lt(d2, hn::Mul(reach, reach)), mask);
      bits |= static_cast<std::uint32_t>(mask[0]) << g;
    }
    const std::size_t valid = std::min<std::size_t>(8, to - p);
    bits &= (1u << valid) - 1;
    std::uint64_t before;
    std::memcpy(&before, v.touching + p, 8);  // the list is padded
    if (valid < 8) before &= (std::uint64_t{1} << (8 * valid)) - 1;
    // One byte per bit, bit k to byte k (two halves: a multiplication spreads four bits without carries).
    const std::uint64_t here = ((bits & 15) * 0x00204081ull & 0x01010101ull) | (((bits >> 4) * 0x00204081ull & 0x01010101ull) << 32);
    for (std::uint64_t other = here ^ before; other != 0; other &= other - 1)
      changed.pair[changed.count++] = static_cast<std::uint32_t>(p) + static_cast<std::uint32_t>(std::countr_zero(other)) / 8;
    for (std::uint32_t k = 0; k < 8; ++k) {
      now.pair[n] = static_cast<std::uint32_t>(p) + k;
      n += bits >> k & 1u;
    }
  }
  now.count = n;
}

void load_lanes(const PairView& v, const std::uint32_t* pair, int count, PairBatch& b) {
  const D d;
  const auto* sphere = reinterpret_cast<const double*>(v.sphere);
  const auto* motion = reinterpret_cast<const double*>(v.motion);
  for (int g = 0; g < (count + 7) / 8 * 8; g += kLanes) {
    const double *is[kLanes], *js[kLanes], *im[kLanes], *jm[kLanes], *h[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const std::size_t p = pair[std::min(g + l, count - 1)], i = v.first(p), j = v.second(p);
      is[l] = sphere + 4 * i, js[l] = sphere + 4 * j, im[l] = motion + 8 * i, jm[l] = motion + 8 * j, h[l] = v.history + std::size_t{v.place[p]} * v.history_width;
    }
    const Apart a = apart(v, is, js);
    hn::Store(a.x, d, b.from_i_x + g), hn::Store(a.y, d, b.from_i_y + g), hn::Store(a.z, d, b.from_i_z + g);
    hn::Store(a.ri, d, b.radius_i + g), hn::Store(a.rj, d, b.radius_j + g);
    V i[8], j[8];
    load_rows8(im, i), load_rows8(jm, j);
    hn::Store(hn::Sub(j[0], i[0]), d, b.dv_x + g), hn::Store(hn::Sub(j[1], i[1]), d, b.dv_y + g), hn::Store(hn::Sub(j[2], i[2]), d, b.dv_z + g);
    hn::Store(i[3], d, b.wi_x + g), hn::Store(i[4], d, b.wi_y + g), hn::Store(i[5], d, b.wi_z + g);
    hn::Store(j[3], d, b.wj_x + g), hn::Store(j[4], d, b.wj_y + g), hn::Store(j[5], d, b.wj_z + g);
    hn::Store(i[6], d, b.inverse_mass_i + g), hn::Store(j[6], d, b.inverse_mass_j + g);
    if (v.history_width == 6) {
      load_rows6(h, i);
    } else {
      load_rows8(h, i);
      hn::Store(i[6], d, b.history[6] + g);
    }
    for (int c = 0; c < 6; ++c) hn::Store(i[c], d, b.history[c] + g);
  }
}

constexpr int kParts = 8 / kLanes;  // vectors of a LoadRow or Motion
struct Row8 {
  V part[kParts];
};
HWY_INLINE Row8 load_row(const double* p) {
  Row8 r;
  for (int k = 0; k < kParts; ++k) r.part[k] = hn::Load(D(), p + k * kLanes);
  return r;
}
/// Lanes (c[k][l] = number k of row l) to rows: part k of row l is c[k * kLanes + l] afterwards.
HWY_INLINE void turn_to_rows(V* c) {
#if HWY_TARGET != HWY_SCALAR
  for (int h = 0; h < 8; h += kSquare) turn(c + h);
#else
  (void)c;
#endif
}
HWY_INLINE void add_row(double* sum, const V* c, int l) {
  for (int k = 0; k < kParts; ++k) hn::Store(hn::Add(hn::Load(D(), sum + k * kLanes), c[k * kLanes + l]), D(), sum + k * kLanes);
}

std::uint32_t add_lanes(const PairView& v, const std::uint32_t* pair, int count, const PairBatch& b, double watch) {
  const D d;
  std::uint32_t deep = 0;
  for (int g = 0; g < count; g += kLanes) {
    const int valid = std::min(kLanes, count - g);
    double* h[kLanes];
    for (int l = 0; l < kLanes; ++l) h[l] = v.history + std::size_t{v.place[pair[std::min(g + l, count - 1)]]} * v.history_width;
    V c[8];
    for (int k = 0; k < 6; ++k) c[k] = hn::Load(d, b.history[k] + g);
    if (v.history_width == 6) {
      store_rows6(c, h);
    } else {
      c[6] = hn::Load(d, b.history[6] + g), c[7] = hn::Zero(d);
      store_rows8(c, h);
    }
    V first[8], second[8];
    first[0] = hn::Load(d, b.force_x + g), first[1] = hn::Load(d, b.force_y + g), first[2] = hn::Load(d, b.force_z + g);
    first[3] = hn::Load(d, b.torque_i_x + g), first[4] = hn::Load(d, b.torque_i_y + g), first[5] = hn::Load(d, b.torque_i_z + g);
    for (int k = 0; k < 3; ++k) second[k] = hn::Neg(first[k]);  // Newton's third law
    second[3] = hn::Load(d, b.torque_j_x + g), second[4] = hn::Load(d, b.torque_j_y + g), second[5] = hn::Load(d, b.torque_j_z + g);
    first[6] = first[7] = second[6] = second[7] = hn::Zero(d);
    turn_to_rows(first), turn_to_rows(second);
    const auto add = [&](int l) HWY_ATTR {
      const std::size_t p = pair[g + l], j = std::min<std::size_t>(v.second(p) - v.block_start, kGrainsPerBlock);
      add_row(v.sum[v.own[p]].v, first, l);
      add_row(v.sum[j].v, second, l);
      if (v.kept != nullptr)
        for (int k = 0; k < kParts; ++k) hn::Store(first[k * kLanes + l], d, v.kept[v.place[p]].v + k * kLanes);
    };
    if (valid == kLanes) {
#pragma GCC unroll 8
      for (int l = 0; l < kLanes; ++l) add(l);
    } else {
      for (int l = 0; l < valid; ++l) add(l);
    }
    const V small = hn::Min(hn::Load(d, b.radius_i + g), hn::Load(d, b.radius_j + g));
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(d, hn::Gt(hn::Load(d, b.overlap + g), hn::Mul(hn::Set(d, watch), small)), mask);
    deep |= (static_cast<std::uint32_t>(mask[0]) & ((1u << valid) - 1)) << g;
  }
  return deep;
}

/// v += (half / m) F + half g, w += (half / I) T; the inverse mass and inertia that stand behind them get zeros.
HWY_INLINE void kick(Row8& m, const Row8& load, const Row8& rate, const Row8& fall) {
  for (int k = 0; k < kParts; ++k) m.part[k] = hn::Add(hn::Add(m.part[k], hn::Mul(rate.part[k], load.part[k])), fall.part[k]);
}

void move_grains(const MoveView& v, std::size_t start, std::size_t end, MoveBook& book) {
  const D d;
  const hn::CappedTag<double, 4> d4;
  constexpr std::size_t kLanes4 = hn::MaxLanes(hn::CappedTag<double, 4>());
  hn::Vec<hn::CappedTag<double, 4>> farthest[4 / kLanes4];
  for (std::size_t k = 0; k < 4; k += kLanes4) farthest[k / kLanes4] = hn::Load(d4, book.relative + k);
  const double half = 0.5 * v.time_step;
  alignas(32) const double dt[4] = {v.time_step, v.time_step, v.time_step, 0};
  LoadRow fall, none, ones, ones_below;
  for (int k = 0; k < 3; ++k) fall.v[k] = half * v.gravity.v[k], ones.v[k] = ones_below.v[k + 3] = 1;
  const Row8 force_lanes = load_row(ones.v), torque_lanes = load_row(ones_below.v);
  const Row8 falls = load_row(fall.v), rests = load_row(none.v);
  for (std::size_t s = start; s < end; ++s) {
    const double inverse_mass = v.motion[s].inverse_mass, inverse_inertia = v.motion[s].inverse_inertia;
    Row8 m = load_row(reinterpret_cast<const double*>(v.motion + s)), load, rate;
    if (v.sum != nullptr) {
      load = load_row(v.sum[s - start].v);
    } else {
      const Load& l = v.load[s];
      LoadRow row;
      row.v[0] = l.force.x, row.v[1] = l.force.y, row.v[2] = l.force.z, row.v[3] = l.torque.x, row.v[4] = l.torque.y, row.v[5] = l.torque.z;
      load = load_row(row.v);
    }
    // Vectors from vectors: a row put together from numbers in memory would wait for them to arrive there.
    for (int k = 0; k < kParts; ++k)
      rate.part[k] =
          hn::Add(hn::Mul(hn::Set(d, half * inverse_mass), force_lanes.part[k]), hn::Mul(hn::Set(d, half * inverse_inertia), torque_lanes.part[k]));
    const Row8& fall_here = inverse_mass > 0 ? falls : rests;
    if (v.sum != nullptr) kick(m, load, rate, fall_here);
    kick(m, load, rate, fall_here);
    alignas(64) double row[8];
    auto* motion = reinterpret_cast<double*>(v.next_motion + s);
    for (int k = 0; k < kParts; ++k) {
      hn::Store(m.part[k], d, row + k * kLanes);
      if (v.stream)
        hn::Stream(m.part[k], d, motion + k * kLanes);
      else
        hn::Store(m.part[k], d, motion + k * kLanes);
    }
    // The radius stands behind the position: its lanes of time, snap and centre are 0.
    for (std::size_t k = 0; k < 4; k += kLanes4) {
      const auto velocity = hn::Load(d4, row + k), snap = hn::LoadU(d4, v.snap + k);
      const auto way = hn::Sub(hn::Add(hn::Mul(velocity, hn::Load(d4, dt + k)), snap), snap);
      const auto to = hn::Add(hn::Load(d4, &v.sphere[s].x + k), way);
      if (v.stream)
        hn::Stream(to, d4, &v.next_sphere[s].x + k);
      else
        hn::Store(to, d4, &v.next_sphere[s].x + k);
      farthest[k / kLanes4] = hn::Max(hn::Abs(hn::Sub(velocity, hn::LoadU(d4, v.centre + k))), farthest[k / kLanes4]);
    }
    const double vx = row[0], vy = row[1], vz = row[2];
    const double speed2 = vx * vx + vy * vy + vz * vz;
    if (!(speed2 <= book.speed2)) book.speed2 = speed2, book.fastest = s;  // NaN wins
  }
  for (std::size_t k = 0; k < 4; k += kLanes4) hn::Store(farthest[k / kLanes4], d4, book.relative + k);
}
}  // namespace venato::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace venato::dem {
HWY_EXPORT(find_touching);
HWY_EXPORT(load_lanes);
HWY_EXPORT(add_lanes);
HWY_EXPORT(move_grains);
void find_touching(const PairView& v, std::size_t from, std::size_t to, PairChunk& now, PairChunk& changed) {
  HWY_DYNAMIC_DISPATCH(find_touching)(v, from, to, now, changed);
}
void load_lanes(const PairView& v, const std::uint32_t* pair, int count, PairBatch& b) { HWY_DYNAMIC_DISPATCH(load_lanes)(v, pair, count, b); }
void move_grains(const MoveView& v, std::size_t start, std::size_t end, MoveBook& book) { HWY_DYNAMIC_DISPATCH(move_grains)(v, start, end, book); }
void flush_stream() { hwy::FlushStream(); }
std::uint32_t add_lanes(const PairView& v, const std::uint32_t* pair, int count, const PairBatch& b, double watch) {
  return HWY_DYNAMIC_DISPATCH(add_lanes)(v, pair, count, b, watch);
}
}  // namespace venato::dem
#endif
