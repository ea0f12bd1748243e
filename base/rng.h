#pragma once
#include <array>
#include <cstdint>
#include <string_view>
namespace venato {

/// Identifier of a named random stream (FNV-1a of its path, e.g. stream_id("line/belt_jitter")).
/// A test asserts that all ids used in the tree differ.
constexpr std::uint64_t stream_id(std::string_view path) {
  std::uint64_t h = 14695981039346656037ull;
  for (char c : path) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return h;
}

/// Philox4x32-10 block function. Source: Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC11.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Counter-based random numbers: a value depends only on (run seed, stream, entity, step) and on how many were drawn from
/// this object, never on threads or on the order of calls elsewhere.
class Rng {
 public:
  Rng(std::uint64_t run_seed, std::uint64_t stream, std::uint64_t entity = 0, std::uint64_t step = 0);
  std::uint32_t bits();                  ///< 32 uniform bits
  double uniform();                      ///< in [0, 1), 53 bits
  double normal();                       ///< mean 0, variance 1 (Box-Muller; both values of a pair are used)
  std::uint64_t below(std::uint64_t n);  ///< uniform integer in [0, n), n >= 1

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_, block_{};
  int used_ = 4;
  bool have_spare_ = false;
  double spare_ = 0;
};
}  // namespace venato
