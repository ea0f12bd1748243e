#include "dem/fields/window_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"

namespace venato::dem {
namespace {
constexpr double kCell = 1e-3, kHeight = 10e-3, kLength = 8e-3, kWidth = 5e-3, kFrame_s = 0.01, kShear = 20;  // m, m, m, m, s, 1/s
const FieldGrid kGrid{0, 0, kCell, 8, 10};

struct Motion {
  double shear = 0, d_xx = 0, d_yy = 0, d_zz = 0;  // 1/s, m^2/s
};

/// Grains of 0.4 mm in a slab, y periodic with the length of the grid (positions unwrapped), z folded at 0 and kHeight; Euler steps of one frame
/// whose mean displacement uses the midpoint height: the estimator's model exactly.
std::vector<Snapshot> brownian(int grains, int frames, const Motion& m, std::uint64_t seed) {
  std::vector<Snapshot> out(static_cast<std::size_t>(frames));
  std::vector<Vec3> x(static_cast<std::size_t>(grains));
  for (std::size_t k = 0; k < x.size(); ++k) {
    Rng rng(seed, stream_id("tests/fields/start"), k);
    x[k] = Vec3(kWidth * rng.uniform(), kLength * rng.uniform(), kHeight * rng.uniform());
  }
  for (int f = 0; f < frames; ++f) {
    Snapshot& s = out[static_cast<std::size_t>(f)];
    s.time_s = f * kFrame_s;
    for (std::size_t k = 0; k < x.size(); ++k) {
      s.id.push_back(static_cast<std::int64_t>(k));
      s.position_m.push_back(x[k]);
      s.velocity_m_s.push_back(Vec3(0, m.shear * x[k].z(), 0));
      s.radius_m.push_back(0.2e-3f);
      s.species.push_back(0);
      Rng rng(seed, stream_id("tests/fields/step"), k, static_cast<std::uint64_t>(f));
      const double z0 = x[k].z();
      double z1 = z0 + std::sqrt(2 * m.d_zz * kFrame_s) * rng.normal();
      if (z1 < 0) z1 = -z1;
      if (z1 > kHeight) z1 = 2 * kHeight - z1;
      x[k] += Vec3(std::sqrt(2 * m.d_xx * kFrame_s) * rng.normal(),
                   m.shear * 0.5 * (z0 + z1) * kFrame_s + std::sqrt(2 * m.d_yy * kFrame_s) * rng.normal(), z1 - z0);
    }
  }
  return out;
}

FieldOptions options() {
  FieldOptions o;
  o.slice_width_m = kWidth;
  o.periodic_y = true;
  return o;
}

/// Mean over the rows j in [from, to) of one field.
double row_mean(const std::vector<double>& field, int from, int to) {
  double sum = 0;
  for (int j = from; j < to; ++j)
    for (int i = 0; i < kGrid.ny; ++i) sum += field[kGrid.index(i, j)];
  return sum / (kGrid.ny * (to - from));
}

TEST(WindowFields, uniform_shear_without_diffusion_is_exact) {
  std::vector<Snapshot> frames(4);  // a lattice symmetric about the cell centres
  for (std::size_t f = 0; f < frames.size(); ++f) {
    frames[f].time_s = 0.1 + static_cast<double>(f) * kFrame_s;
    for (int k = 0; k < 32 * 40; ++k) {
      const double y = (k % 32 + 0.5) * kCell / 4, z = (k / 32 + 0.5) * kCell / 4;
      frames[f].id.push_back(k);
      frames[f].position_m.emplace_back(0, y + kShear * z * static_cast<double>(f) * kFrame_s, z);
      frames[f].velocity_m_s.emplace_back(0, 0, 0);
      frames[f].radius_m.push_back(1e-4f);
      frames[f].species.push_back(0);
    }
  }
  FieldOptions o = options();
  o.min_samples = 1;
  const WindowFields fields = estimate_fields(frames, kGrid, o);
  for (int j = 0; j < kGrid.nz; ++j)
    for (int i = 0; i < kGrid.ny; ++i) {
      const std::size_t c = kGrid.index(i, j);
      EXPECT_NEAR(fields.velocity_y_m_s[c], kShear * (j + 0.5) * kCell, 1e-12);  // rounding: sums of ~ 50 numbers of 0.2 m/s
      EXPECT_NEAR(fields.velocity_z_m_s[c], 0, 1e-15);
      // Nothing left after subtracting the flow along the path: the gradient inside cells (also the outer ones) is used, 1e-12 of (0.2 m/s)^2 * 0.01
      // s.
      EXPECT_NEAR(fields.d_yy_m2_s[c], 0, 4e-16);
      EXPECT_NEAR(fields.d_yz_m2_s[c], 0, 4e-16);
    }
}

TEST(WindowFields, shear_and_brownian_motion_are_told_apart) {
  const Motion m{kShear, 1e-7, 2e-7, 0.5e-7};
  const auto frames = brownian(4000, 61, m, 5);
  const WindowFields fields = estimate_fields(frames, kGrid, options());
  // Brownian motion is on its plateau from the first lag on.
  EXPECT_NEAR(fields.lag_s, kFrame_s, 1e-12);
  // Rows 1 … 8 (folding at the walls changes the outer rows): 4000 * 0.8 * 60 stretches, relative standard error of a variance sqrt(2 / 192000) =
  // 0.32 %; five of them.
  EXPECT_NEAR(row_mean(fields.d_xx_m2_s, 1, 9) / m.d_xx, 1, 0.016);
  EXPECT_NEAR(row_mean(fields.d_yy_m2_s, 1, 9) / m.d_yy, 1, 0.016);
  EXPECT_NEAR(row_mean(fields.d_zz_m2_s, 1, 9) / m.d_zz, 1, 0.016);
  // xi_y xi_z of independent steps: standard error sqrt(Dyy Dzz / 192000) = 2.3e-10; five of them.
  EXPECT_NEAR(row_mean(fields.d_yz_m2_s, 1, 9), 0, 1.15e-9);
  for (int j = 0; j < kGrid.nz; ++j)
    for (int i = 0; i < kGrid.ny; ++i)
      // Per cell ~ 3000 displacements: noise sqrt(2 Dyy / (0.01 s * 3000)) = 1.2e-4 m/s and the mean height in the cell, shear * 0.29 mm / sqrt(50
      // grains) = 8e-4 m/s; six of the larger (80 cells).
      EXPECT_NEAR(fields.velocity_y_m_s[kGrid.index(i, j)], kShear * (j + 0.5) * kCell, 5e-3);
}

TEST(WindowFields, forgetting_the_mean_flow_would_be_seen) {
  // Negative control of the test above: the same estimator on a coordinate frame that hides the shear's gradient (one cell over the whole height)
  // has the shear in D_yy: (shear * H)^2 / 12 * tau / 2, hundreds of times the true value, unless the gradient inside cells were known.
  const auto frames = brownian(2000, 31, {kShear, 1e-7, 2e-7, 0.5e-7}, 5);
  const FieldGrid one{0, 0, kHeight, 1, 1};
  FieldOptions o = options();
  o.periodic_y = false;
  o.lag_s = kFrame_s;
  std::vector<Snapshot> inside = frames;
  for (Snapshot& s : inside)
    for (Vec3& x : s.position_m) x.y() *= 1e-3;  // keeps all in the cell; D_yy and shear shrink by 1e-6 and 1e-3
  const WindowFields fields = estimate_fields(inside, one, o);
  const double shear_part = std::pow(kShear * 1e-3 * kHeight, 2) / 12 * kFrame_s / 2;
  EXPECT_NEAR(fields.d_yy_m2_s[0] / (shear_part + 2e-7 * 1e-6), 1, 0.05);  // uniform heights of 2000 grains: variance known to sqrt(0.8 / 2000) = 2 %
  EXPECT_GT(shear_part / (2e-7 * 1e-6), 50);
}

TEST(WindowFields, coarse_graining_divides_by_its_square) {
  const auto frames = brownian(500, 21, {0, 1e-7, 1e-7, 1e-7}, 9);
  FieldOptions o = options();
  const WindowFields one = estimate_fields(frames, kGrid, o);
  o.coarse_graining = 3;
  const WindowFields three = estimate_fields(frames, kGrid, o);
  for (std::size_t c = 0; c < kGrid.size(); ++c) {
    EXPECT_NEAR(three.d_zz_m2_s[c] * 9, one.d_zz_m2_s[c], 1e-12 * one.d_zz_m2_s[c]);
    EXPECT_EQ(three.velocity_y_m_s[c], one.velocity_y_m_s[c]);
    EXPECT_EQ(three.solid_fraction[c], one.solid_fraction[c]);
  }
}

TEST(WindowFields, solid_fraction_holds_all_grain_volume) {
  const auto frames = brownian(800, 5, {kShear, 1e-7, 1e-7, 1e-7}, 2);
  FieldOptions o = options();
  o.min_samples = 0;
  const WindowFields fields = estimate_fields(frames, kGrid, o);
  double volume = 0;
  for (std::size_t c = 0; c < kGrid.size(); ++c) volume += fields.solid_fraction[c] * kCell * kCell * kWidth;
  const auto r = static_cast<double>(0.2e-3f);
  const double grains = 800 * 4.0 / 3 * std::numbers::pi * r * r * r;
  double masked = 0;  // a cell that no displacement fell in is masked even then
  for (double s : fields.samples) masked += s == 0;
  ASSERT_EQ(masked, 0);
  EXPECT_NEAR(volume / grains, 1, 1e-12);  // cloud-in-cell loses nothing: rounding
}

TEST(WindowFields, cells_with_few_samples_are_masked) {
  auto frames = brownian(400, 11, {kShear, 1e-7, 1e-7, 1e-7}, 3);
  for (Snapshot& s : frames)
    for (Vec3& x : s.position_m) x.z() *= 0.5;  // the upper half is empty
  FieldOptions o = options();
  o.min_samples = 20;
  const WindowFields fields = estimate_fields(frames, kGrid, o);
  int masked = 0;
  for (std::size_t c = 0; c < kGrid.size(); ++c) {
    const bool few = fields.samples[c] < 20;
    masked += few;
    if (!few) continue;
    for (const auto* v : {&fields.solid_fraction, &fields.velocity_y_m_s, &fields.d_xx_m2_s, &fields.d_yy_m2_s, &fields.d_zz_m2_s})
      EXPECT_EQ((*v)[c], 0);
  }
  EXPECT_GE(masked, 40);
  EXPECT_LT(masked, 80);
}

TEST(WindowFields, frame_weights_choose_the_frames_of_displacements) {
  const auto frames = brownian(1000, 31, {kShear, 1e-7, 2e-7, 1e-7}, 4);
  FieldOptions o = options();
  o.min_samples = 1;
  o.lag_s = kFrame_s;
  o.frame_weights.assign(31, 0);
  for (std::size_t f = 0; f < 10; ++f) o.frame_weights[f] = 1;
  const WindowFields weighted = estimate_fields(frames, kGrid, o);
  o.frame_weights.clear();
  const WindowFields first = estimate_fields(std::span(frames).first(11), kGrid, o);
  for (std::size_t c = 0; c < kGrid.size(); ++c) {
    EXPECT_NEAR(weighted.velocity_y_m_s[c], first.velocity_y_m_s[c], 1e-12);
    EXPECT_NEAR(weighted.d_yy_m2_s[c], first.d_yy_m2_s[c], 1e-6 * 2e-7);
  }
  o.frame_weights.assign(31, 2);
  const WindowFields doubled = estimate_fields(frames, kGrid, o);
  o.frame_weights.clear();
  const WindowFields plain = estimate_fields(frames, kGrid, o);
  for (std::size_t c = 0; c < kGrid.size(); ++c) EXPECT_NEAR(doubled.solid_fraction[c], plain.solid_fraction[c], 1e-12);
  o.frame_weights.assign(7, 1);
  EXPECT_THROW(estimate_fields(frames, kGrid, o), UsageError);
}

TEST(WindowFields, the_lag_leaves_the_ballistic_stage) {
  // Ornstein-Uhlenbeck velocities, correlation time 4 frames: D(tau) = v^2 tau_c (1 - tau_c/tau (1 - e^(-tau/tau_c))) climbs to v^2 tau_c.
  constexpr double kTau = 4 * kFrame_s, kSpeed = 1e-3;
  constexpr int kGrains = 3000, kFrames = 201;
  std::vector<Snapshot> frames(kFrames);
  const double keep = std::exp(-kFrame_s / kTau);
  for (std::size_t k = 0; k < kGrains; ++k) {
    Rng rng(3, stream_id("tests/fields/ou"), k);
    Vec3 x(0, kLength * rng.uniform(), kHeight * (0.3 + 0.4 * rng.uniform()));
    Vec3 v = kSpeed * Vec3(rng.normal(), rng.normal(), rng.normal());
    for (std::size_t f = 0; f < kFrames; ++f) {
      frames[f].time_s = static_cast<double>(f) * kFrame_s;
      frames[f].id.push_back(static_cast<std::int64_t>(k));
      frames[f].position_m.push_back(x);
      frames[f].velocity_m_s.push_back(v);
      frames[f].radius_m.push_back(2e-4f);
      frames[f].species.push_back(0);
      x += v * kFrame_s;
      v = keep * v + kSpeed * std::sqrt(1 - keep * keep) * Vec3(rng.normal(), rng.normal(), rng.normal());
    }
  }
  const double plateau = kSpeed * kSpeed * kFrame_s * (0.5 + keep / (1 - keep));  // of the discrete process
  FieldOptions o = options();
  o.max_lag_s = 1.0;
  const WindowFields fields = estimate_fields(frames, kGrid, o);
  EXPECT_GT(fields.lag_s, 6 * kTau);
  EXPECT_LT(fields.lag_s, 0.8);
  // Within 5 % of the mean over long lags, which itself is up to tau_c / (0.7 s) = 6 % below the limit: [-13, +3] % with the sampling error of 1 %.
  EXPECT_NEAR(row_mean(fields.d_xx_m2_s, 4, 6) / plateau, 0.95, 0.08);
  o.lag_s = kFrame_s;  // negative control: the first lag is ballistic
  EXPECT_LT(row_mean(estimate_fields(frames, kGrid, o).d_xx_m2_s, 4, 6) / plateau, 0.2);
}

TEST(WindowFields, grains_that_come_and_go_are_followed_while_they_are_there) {
  auto frames = brownian(1000, 41, {kShear, 1e-7, 2e-7, 0.5e-7}, 6);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    Snapshot gone = frames[f];
    gone.id.clear(), gone.position_m.clear(), gone.radius_m.clear(), gone.velocity_m_s.clear(), gone.species.clear();
    for (std::size_t k = 0; k < frames[f].id.size(); ++k) {
      if ((f / 7 + k) % 4 == 0) continue;  // away for 7 frames at a time
      gone.id.push_back(frames[f].id[k]);
      gone.position_m.push_back(frames[f].position_m[k]);
      gone.radius_m.push_back(frames[f].radius_m[k]);
      gone.velocity_m_s.push_back(frames[f].velocity_m_s[k]);
      gone.species.push_back(0);
    }
    frames[f] = gone;
  }
  FieldOptions o = options();
  o.lag_s = 2 * kFrame_s;
  const WindowFields fields = estimate_fields(frames, kGrid, o);
  // ~ 800 grains of the inner rows * 0.75 * 38 / 2 independent stretches = 11000: standard error 1.3 %; five of them.
  EXPECT_NEAR(row_mean(fields.d_xx_m2_s, 1, 9) / 1e-7, 1, 0.066);
  EXPECT_NEAR(row_mean(fields.d_yy_m2_s, 1, 9) / 2e-7, 1, 0.066);
}

TEST(WindowFields, bad_input_is_refused) {
  const auto frames = brownian(10, 4, {}, 1);
  FieldOptions o = options();
  EXPECT_THROW(estimate_fields(std::span(frames).first(2), kGrid, o), UsageError);
  EXPECT_THROW(estimate_fields(frames, FieldGrid{0, 0, 0, 8, 10}, o), UsageError);
  o.slice_width_m = 0;
  EXPECT_THROW(estimate_fields(frames, kGrid, o), UsageError);
  o = options();
  o.coarse_graining = 0;
  EXPECT_THROW(estimate_fields(frames, kGrid, o), UsageError);
  auto backwards = frames;
  backwards[2].time_s = 0;
  EXPECT_THROW(estimate_fields(backwards, kGrid, options()), UsageError);
}

TEST(Stationarity, steady_shear_passes) {
  const auto report = check_stationarity(brownian(2000, 41, {kShear, 1e-7, 2e-7, 0.5e-7}, 7), kGrid, true);
  EXPECT_TRUE(report.ok);
  EXPECT_LT(report.velocity_change, 0.05);
  EXPECT_LT(report.velocity_change_sigmas, 3);
  EXPECT_LT(report.kinetic_energy_drift, 0.02);
  EXPECT_LT(report.height_drift, 0.02);
}

std::vector<Snapshot> changed(const std::function<void(Snapshot&, double)>& change) {
  auto frames = brownian(2000, 41, {kShear, 1e-7, 2e-7, 0.5e-7}, 7);
  for (Snapshot& s : frames) change(s, s.time_s / frames.back().time_s);
  return frames;
}

TEST(Stationarity, each_drift_is_caught) {
  // Flow that becomes 20 % faster: y stretched so that dy/dt grows linearly from 0.9 to 1.1 of the shear.
  const auto faster = changed([](Snapshot& s, double t) {
    for (Vec3& x : s.position_m) x.y() += kShear * x.z() * s.time_s * (-0.1 + 0.1 * t);
  });
  const auto velocity = check_stationarity(faster, kGrid, true);
  EXPECT_FALSE(velocity.ok);
  EXPECT_NEAR(velocity.velocity_change, 0.1, 0.02);  // mean speeds of the halves 0.95 and 1.05
  EXPECT_GT(velocity.velocity_change_sigmas, 3);

  const auto heating = check_stationarity(changed([](Snapshot& s, double t) {
                                            for (Vec3& v : s.velocity_m_s) v *= 1 + 0.05 * t;
                                          }),
                                          kGrid, true);
  EXPECT_FALSE(heating.ok);
  EXPECT_NEAR(heating.kinetic_energy_drift, 0.05, 0.01);  // energy grows by 10 % over the window, halves differ by half of that

  const auto rising = check_stationarity(changed([](Snapshot& s, double t) {
                                           for (Vec3& x : s.position_m) x.z() *= 1 - 0.1 * t;
                                         }),
                                         kGrid, true);
  EXPECT_FALSE(rising.ok);
  EXPECT_NEAR(rising.height_drift, 0.05, 0.01);
}

TEST(Stationarity, nothing_that_moves_is_not_stationary_flow) {
  EXPECT_FALSE(check_stationarity(brownian(500, 11, {}, 7), kGrid, true).ok);
  EXPECT_THROW(check_stationarity(brownian(10, 8, {}, 7), kGrid), UsageError);
}
}  // namespace
}  // namespace venato::dem
