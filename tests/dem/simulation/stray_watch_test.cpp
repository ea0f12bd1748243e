// The watch over a block's grains must say "strayed" in the very step in which looking at every path says so.
#include "dem/simulation/stray_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace venato::dem {
namespace {
constexpr double kStep = 1e-5;
constexpr int kGrains = 40;

/// Grains whose paths and velocities differ; grain k leaves its path in a circling way, slowly at first.
struct Block {
  std::vector<Sphere> sphere;
  std::vector<Anchor> anchor;
  Block() {
    for (int k = 0; k < kGrains; ++k) {
      const double x = 1e-3 * k;
      sphere.push_back({x, -x, 2 * x, 1e-3});
      anchor.push_back({x, -x, 2 * x, 6e-5f, 0.5f + 0.01f * static_cast<float>(k), -0.2f, 0.003f * static_cast<float>(k % 7)});
    }
  }
  std::vector<double> velocity(int grain, int step) const {
    const Anchor& a = anchor[static_cast<std::size_t>(grain)];
    const double about = 0.02 * (1 + grain % 5), turn = 2 * std::numbers::pi * step / 300.0 + grain;
    return {static_cast<double>(a.drift_x) + about * std::cos(turn), static_cast<double>(a.drift_y) + about * std::sin(turn),
            static_cast<double>(a.drift_z) + 0.001 * grain * std::cos(3 * turn)};
  }
  void move(int step) {
    for (int k = 0; k < kGrains; ++k) {
      const std::vector<double> v = velocity(k, step);
      Sphere& s = sphere[static_cast<std::size_t>(k)];
      s.x += kStep * v[0], s.y += kStep * v[1], s.z += kStep * v[2];
    }
  }
  std::vector<double> fastest(const double* centre, int step) const {
    std::vector<double> most(4, 0.0);
    for (int k = 0; k < kGrains; ++k) {
      const std::vector<double> v = velocity(k, step);
      for (std::size_t a = 0; a < 3; ++a) most[a] = std::max(most[a], std::abs(v[a] - centre[a]));
    }
    return most;
  }
  bool strayed(double seconds) const {
    for (std::size_t k = 0; k < sphere.size(); ++k) {
      const double allowance = static_cast<double>(anchor[k].allowance);
      if (!(anchor[k].strayed2(sphere[k].x, sphere[k].y, sphere[k].z, seconds) <= allowance * allowance)) return true;
    }
    return false;
  }
};

struct Found {
  int step = -1, looks = 0;
};

/// \param faulty the watch adds up no way
Found first_straying(bool by_watch, bool faulty = false) {
  Block block;
  StrayWatch watch;
  Found found;
  for (int step = 0; step < 2000; ++step) {
    const std::vector<double> fastest = block.fastest(watch.centre, step);
    block.move(step);
    const double seconds = kStep * (step + 1);
    bool strayed = false;
    if (!by_watch) {
      strayed = block.strayed(seconds);
    } else {
      std::vector<double> way = fastest;
      if (faulty) watch.spread = 0, std::fill(way.begin(), way.end(), 0.0);
      if (!watch.all_within(way.data(), kStep, 1e-15)) {
        ++found.looks;
        strayed = watch.look(block.sphere, block.anchor, seconds);
      }
    }
    if (strayed) {
      found.step = step;
      return found;
    }
  }
  return found;
}

TEST(StrayWatch, says_the_same_as_looking_at_every_path_in_every_step) {
  const Found every = first_straying(false), watched = first_straying(true);
  ASSERT_GT(every.step, 50);
  EXPECT_EQ(watched.step, every.step);
  EXPECT_LT(watched.looks, every.step / 2) << "no gain from watching";
}

TEST(StrayWatch, control_that_counts_no_way_misses_it) { EXPECT_NE(first_straying(true, true).step, first_straying(false).step); }

TEST(StrayWatch, looks_at_once_and_at_whatever_is_not_a_number) {
  StrayWatch watch;
  const double still[4] = {}, nowhere[4] = {std::numeric_limits<double>::quiet_NaN(), 0, 0, 0};
  EXPECT_FALSE(watch.all_within(still, kStep, 0));
  Block block;
  EXPECT_FALSE(watch.look(block.sphere, block.anchor, 0));
  EXPECT_TRUE(watch.all_within(still, kStep, 0));
  EXPECT_FALSE(watch.all_within(nowhere, kStep, 0));
  block.sphere[7].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(watch.look(block.sphere, block.anchor, 0));
  EXPECT_FALSE(watch.all_within(still, kStep, 0)) << "after a straying there is no slack";
}

TEST(StrayWatch, grains_without_a_path_do_not_count) {
  StrayWatch watch;
  EXPECT_FALSE(watch.look({}, {}, 1.0));
  const double fast[4] = {100, 0, 0, 0};
  EXPECT_TRUE(watch.all_within(fast, 1.0, 0));
}
}  // namespace
}  // namespace venato::dem
