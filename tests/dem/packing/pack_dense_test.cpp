#include "dem/packing/pack_dense.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
#include "dem/psd/size_distribution.h"
#include "dem/simulation/simulation.h"

namespace venato::dem {
namespace {
constexpr SizeDistribution kMono{380e-6, 2.7, 380e-6, 380e-6}, kPoly{380e-6, 2.7, 200e-6, 700e-6};

std::vector<double> radii_of(const SizeDistribution& psd, std::size_t n) {
  std::vector<double> radii = sample_diameters(psd, 1, n, 3, 5);
  for (double& r : radii) r *= 0.5;
  return radii;
}
double volume_of(const std::vector<double>& radii) {
  double v = 0;
  for (const double r : radii) v += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return v;
}
Box box_for(const std::vector<double>& radii, double fraction, bool periodic_z = true) {
  const double edge = std::cbrt(volume_of(radii) / fraction);
  Box box{Vec3(1e-3, -2e-3, 0), Vec3(1e-3 + edge, -2e-3 + edge, edge), {true, true, periodic_z}};
  return box;
}

struct Found {
  double overlap = 0;  ///< largest, of the smaller radius
  double outside = 0;  ///< largest, of the radius, through a hard face
  bool inside = true;  ///< all centres in the box
};
/// Every pair: slow and obvious.
Found look_at(const Box& box, const std::vector<double>& radii, const std::vector<Vec3>& at) {
  Found f;
  const Vec3 length = box.high - box.low;
  for (std::size_t i = 0; i < at.size(); ++i) {
    f.inside = f.inside && (at[i].array() >= box.low.array()).all() && (at[i].array() <= box.high.array()).all();
    for (int a = 0; a < 3; ++a)
      if (!box.periodic[a])
        f.outside = std::max({f.outside, (radii[i] - at[i][a] + box.low[a]) / radii[i], (radii[i] + at[i][a] - box.high[a]) / radii[i]});
    for (std::size_t j = 0; j < i; ++j) {
      Vec3 d = at[i] - at[j];
      for (int a = 0; a < 3; ++a)
        if (box.periodic[a]) d[a] -= length[a] * std::round(d[a] / length[a]);
      f.overlap = std::max(f.overlap, (radii[i] + radii[j] - d.norm()) / std::min(radii[i], radii[j]));
    }
  }
  return f;
}

struct Target {
  const char* name;
  SizeDistribution psd;
  double fraction;
  bool periodic_z;
};
class Packings : public ::testing::TestWithParam<Target> {};

TEST_P(Packings, OverlapFractionAndBoxAreAsAsked) {
  const Target t = GetParam();
  const std::vector<double> radii = radii_of(t.psd, 1500);
  const Box box = box_for(radii, t.fraction, t.periodic_z);
  const Packing p = pack_dense(box, radii, {1e-3, 11, 0, 1});
  ASSERT_EQ(p.position_m.size(), radii.size());
  EXPECT_NEAR(p.solid_fraction, t.fraction, 1e-12);  // the box was made for it: rounding only
  const Found f = look_at(box, radii, p.position_m);
  EXPECT_TRUE(f.inside);
  EXPECT_LE(f.overlap, 1e-3 * (1 + 1e-9));  // the limit; 1e-9: wrapping rounds coordinates
  EXPECT_LE(f.outside, 1e-3 * (1 + 1e-9));
  EXPECT_NEAR(p.max_overlap, std::max({0.0, f.overlap, f.outside}), 1e-9);  // reported = found by the slow search
}
INSTANTIATE_TEST_SUITE_P(Targets, Packings,
                         ::testing::Values(Target{"mono60", kMono, 0.60, true}, Target{"mono62", kMono, 0.62, true},
                                           Target{"poly62", kPoly, 0.62, true}, Target{"mono_faces", kMono, 0.56, false},
                                           Target{"poly_faces", kPoly, 0.58, false}, Target{"loose", kMono, 0.2, true}),
                         [](const auto& target) { return std::string(target.param.name); });

TEST(PackDense, SameBytesForAnyThreads) {
  const std::vector<double> radii = radii_of(kPoly, 4000);  // several blocks of 1024
  const Box box = box_for(radii, 0.60, false);
  const Packing one = pack_dense(box, radii, {1e-3, 5, 9, 1});
  for (const int threads : {2, 3}) {
    const Packing many = pack_dense(box, radii, {1e-3, 5, 9, threads});
    EXPECT_EQ(many.iterations, one.iterations);
    ASSERT_EQ(std::memcmp(many.position_m.data(), one.position_m.data(), sizeof(Vec3) * radii.size()), 0) << threads << " threads";
  }
  // Negative control: the seed and the stream do change it.
  EXPECT_NE(pack_dense(box, radii, {1e-3, 6, 9, 1}).position_m, one.position_m);
  EXPECT_NE(pack_dense(box, radii, {1e-3, 5, 8, 1}).position_m, one.position_m);
}

TEST(PackDense, SizesGivenInOrderEndUpMixed) {
  std::vector<double> radii = radii_of(kPoly, 2000);
  std::sort(radii.begin(), radii.end());
  const Box box = box_for(radii, 0.58);
  const Packing p = pack_dense(box, radii, {});
  // Mean height of the larger half against the smaller half: both the box's middle within 4 standard errors of 1000 uniform heights.
  double low = 0, high = 0;
  for (std::size_t k = 0; k < radii.size(); ++k) (k < radii.size() / 2 ? low : high) += p.position_m[k].z() / (box.high.z() * 1000);
  const double limit = 4 / std::sqrt(12.0 * 1000);
  EXPECT_NEAR(low, 0.5, limit);
  EXPECT_NEAR(high, 0.5, limit);
}

TEST(PackDense, EngineTakesItWithoutAJump) {
  // Overlaps up to 1e-3 R store so little that the fastest grain stays slow: m v^2 / 2 = 2/5 k_n d^2 with d = 1e-3 R, E* = 5.33 MPa and R* = R/2,
  // from six neighbours at once at most sqrt(6) times 4 mm/s.
  const std::vector<double> radii = radii_of(kMono, 1000);
  SimulationSetup s;
  s.materials = {{{"grain", 2000, 1e7, 0.25}}, {{0.5, 0.5, 0.1, 0.3}}};
  s.box = box_for(radii, 0.6);
  s.gravity_m_s2 = Vec3::Zero();
  s.time_step_s = 2e-6;
  const Packing p = pack_dense(s.box, radii, {});
  Simulation sim(s);
  for (std::size_t k = 0; k < radii.size(); ++k) {
    GrainInput g;
    g.position_m = p.position_m[k];
    g.radius_m = radii[k];
    sim.add_grain(g);
  }
  sim.step(200);
  EXPECT_LT(sim.statistics().max_speed_m_s, 0.01);
  EXPECT_LE(sim.statistics().max_overlap, 1e-3);
}

TEST(PackDense, NothingGivesNothing) { EXPECT_TRUE(pack_dense({Vec3::Zero(), Vec3::Ones(), {}}, {}, {}).position_m.empty()); }

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

TEST(PackDense, RefusesWhatCannotBeSaysWhy) {
  const std::vector<double> radii = radii_of(kMono, 500);
  const auto at_fraction = [&](double fraction) { return refusal([&] { pack_dense(box_for(radii, fraction), radii, {}); }); };
  const std::string jammed = at_fraction(0.68);
  EXPECT_NE(jammed.find("0.68 cannot be reached"), std::string::npos) << jammed;
  EXPECT_NE(jammed.find("jam at 0.64"), std::string::npos) << jammed;
  EXPECT_NE(at_fraction(0.75).find("densest crystal"), std::string::npos);
  EXPECT_EQ(at_fraction(0.60), "");  // control: this one is possible

  Box thin = box_for(radii, 0.5);
  thin.high.x() = thin.low.x() + 2.05 * 380e-6;
  EXPECT_NE(refusal([&] { pack_dense(thin, radii, {}); }).find("along x (periodic)"), std::string::npos);
  Box low = box_for(radii, 0.5, false);
  low.high.z() = low.low.z() + 0.9 * 380e-6;
  EXPECT_NE(refusal([&] { pack_dense(low, radii, {}); }).find("its largest sphere needs 0.38 mm"), std::string::npos);
  Box flat = box_for(radii, 0.5);
  flat.high.y() = flat.low.y();
  EXPECT_NE(refusal([&] { pack_dense(flat, radii, {}); }).find("no extent along y"), std::string::npos);

  const auto bad_radius = [&](double r) {
    std::vector<double> bad = radii;
    bad[7] = r;
    return refusal([&] { pack_dense(box_for(radii, 0.5), bad, {}); });
  };
  for (const double r : {0.0, -1e-4, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_NE(bad_radius(r).find("is not > 0"), std::string::npos) << r;
  for (const double limit : {0.0, 0.3, std::nan("")})
    EXPECT_NE(refusal([&] { pack_dense(box_for(radii, 0.5), radii, {limit, 0, 0, 1}); }).find("overlap limit"), std::string::npos) << limit;
  EXPECT_NE(refusal([&] { pack_dense(box_for(radii, 0.5), radii, {1e-3, 0, 0, 0}); }).find("threads"), std::string::npos);
}

TEST(Coordination, RattlersAreTakenAwayUntilNoneIsLeft) {
  // Five spheres that all touch each other (4 neighbours each), a chain of two hanging on the first, one alone.
  std::vector<std::array<std::int32_t, 2>> pairs{{0, 5}, {5, 6}};
  for (std::int32_t i = 0; i < 5; ++i)
    for (std::int32_t j = i + 1; j < 5; ++j) pairs.push_back({i, j});
  const Coordination c = coordination_of(8, pairs);
  EXPECT_NEAR(c.all, 2 * 12 / 8.0, 1e-15);
  EXPECT_NEAR(c.backbone, 4, 1e-15);
  EXPECT_NEAR(c.rattlers, 3 / 8.0, 1e-15);
  EXPECT_EQ(coordination_of(0, {}).all, 0);
}
}  // namespace
}  // namespace venato::dem
