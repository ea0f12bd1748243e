#include "base/rng.h"

#include <cmath>
#include <numbers>

#include "base/expects.h"

namespace venato {
namespace {
// Constants of Philox4x32: Salmon et al., SC11, table 2 and section 4.3 (multipliers, Weyl increments of the key).
constexpr std::uint32_t kMultiplier0 = 0xD2511F53u, kMultiplier1 = 0xCD9E8D57u;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9u, kWeyl1 = 0xBB67AE85u;
constexpr int kRounds = 10;

constexpr std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
constexpr std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }
}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t p0 = static_cast<std::uint64_t>(kMultiplier0) * c[0];
    const std::uint64_t p1 = static_cast<std::uint64_t>(kMultiplier1) * c[2];
    c = {high(p1) ^ c[1] ^ key[0], low(p1), high(p0) ^ c[3] ^ key[1], low(p0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return c;
}

// (seed, stream, entity, step) plus a draw counter are more than Philox' 192 bits. Stream and step are folded into the key by one block keyed with
// the seed (a random permutation cut to 64 bits: 10^6 pairs collide with probability 3e-8); entities stay exactly disjoint within a pair.
Rng::Rng(std::uint64_t run_seed, std::uint64_t stream, std::uint64_t entity, std::uint64_t step) : counter_{0, 0, low(entity), high(entity)} {
  const auto k = philox4x32({low(stream), high(stream), low(step), high(step)}, {low(run_seed), high(run_seed)});
  key_ = {k[0], k[1]};
}

std::uint32_t Rng::bits() {
  if (used_ == 4) {
    block_ = philox4x32(counter_, key_);
    if (++counter_[0] == 0) ++counter_[1];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

double Rng::uniform() {
  const std::uint64_t a = bits() >> 5, b = bits() >> 6;  // 27 + 26 bits
  return static_cast<double>((a << 26) | b) * 0x1p-53;
}

double Rng::normal() {
  if (have_spare_) {
    have_spare_ = false;
    return spare_;
  }
  const double u = 1.0 - uniform();  // (0, 1]: the logarithm stays finite
  const double radius = std::sqrt(-2.0 * std::log(u));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  have_spare_ = true;
  return radius * std::cos(angle);
}

std::uint64_t Rng::below(std::uint64_t n) {
  VENATO_EXPECTS(n >= 1);
  const std::uint64_t unfair = (0 - n) % n;  // 2^64 mod n: values under it would make the low remainders more frequent
  for (;;) {
    const std::uint64_t hi = bits(), lo = bits();
    const std::uint64_t v = (hi << 32) | lo;
    if (v >= unfair) return v % n;
  }
}
}  // namespace venato
