#include "dem/simulation/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/rng.h"

namespace venato::dem {
namespace {
std::vector<double> loads() {
  std::vector<double> x;
  for (std::uint64_t k = 0; k < 20000; ++k) {
    Rng rng(7, stream_id("tests/exact_sum"), k);
    x.push_back((rng.uniform() - 0.3) * std::pow(10.0, 14 * rng.uniform() - 12));  // 1e-12 … 100 N
  }
  return x;
}
template <class Sum>
double sum_of(const std::vector<double>& x) {
  Sum s;
  for (const double v : x) s.add(v);
  return s.value();
}
struct PlainSum {
  double v = 0;
  void add(double x) { v += x; }
  double value() const { return v; }
};

/// Forwards, backwards, sorted, and in blocks that are added up: the same bytes. A plain sum fails that.
TEST(ExactSum, DoesNotDependOnTheOrder) {
  std::vector<double> x = loads(), back(x.rbegin(), x.rend()), sorted = x;
  std::sort(sorted.begin(), sorted.end());
  const double forwards = sum_of<ExactSum>(x);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(sum_of<ExactSum>(back)), std::bit_cast<std::uint64_t>(forwards));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(sum_of<ExactSum>(sorted)), std::bit_cast<std::uint64_t>(forwards));
  ExactSum blocks;
  for (std::size_t k = 0; k < x.size(); k += 256) {
    ExactSum block;
    for (std::size_t i = k; i < std::min(x.size(), k + 256); ++i) block.add(x[i]);
    blocks.add(block);
  }
  EXPECT_EQ(std::bit_cast<std::uint64_t>(blocks.value()), std::bit_cast<std::uint64_t>(forwards));
  EXPECT_NE(std::bit_cast<std::uint64_t>(sum_of<PlainSum>(sorted)), std::bit_cast<std::uint64_t>(sum_of<PlainSum>(x)));
}
/// Against a sum in extended precision: half a rounding of the result and the resolution of every term.
TEST(ExactSum, IsTheSum) {
  long double exact = 0;
  for (const double v : loads()) exact += v;
  EXPECT_NEAR(sum_of<ExactSum>(loads()), static_cast<double>(exact), std::abs(static_cast<double>(exact)) * 2.3e-16 + 20000 * 3e-21);
  // Smallest loads of a bed: 1e-9 N to 1e-11 of it.
  ExactSum small;
  for (int k = 0; k < 3; ++k) small.add(1e-9);
  EXPECT_NEAR(small.value(), 3e-9, 1e-20);
}
}  // namespace
}  // namespace venato::dem
