#include "line/projection/open_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "line/projection/steady_continuity.h"

using namespace venato;
using namespace venato::line;

namespace {
constexpr double kD = 0.4e-3, kCell = 0.4e-3, kHeight = 20 * kCell, kLength = 100 * kCell;

// A layer 20 cells high and 100 long inside a grid with a masked rim, moving with u(z); diffusivity d everywhere.
template <class Velocity>
dem::WindowFields channel(Velocity u, double d) {
  dem::WindowFields f;
  f.grid = {0, -2 * kCell, kCell, 100, 24};
  const std::size_t n = f.grid.size();
  for (auto* v : {&f.solid_fraction, &f.velocity_y_m_s, &f.velocity_z_m_s, &f.d_xx_m2_s, &f.d_yy_m2_s, &f.d_zz_m2_s, &f.d_yz_m2_s, &f.samples})
    v->assign(n, 0.0);
  for (int j = 2; j < 22; ++j)
    for (int i = 0; i < 100; ++i) {
      const std::size_t c = f.grid.index(i, j);
      f.solid_fraction[c] = 0.55;
      f.velocity_y_m_s[c] = u((j - 1.5) * kCell);
      f.d_xx_m2_s[c] = 2 * d;
      f.d_yy_m2_s[c] = f.d_zz_m2_s[c] = d;
    }
  return f;
}
const Segment kInlet{0, 0, 0, kHeight}, kOutlet{kLength, 0, kLength, kHeight};
ProjectionOptions options() {
  ProjectionOptions o;
  o.grain_diameter_m = kD;
  o.max_time_s = 50;
  return o;
}
double shear(double z) { return 0.02 + 0.1 * z / kHeight; }
}  // namespace

// Without diffusion every tracer keeps its height: theta = L / u(z), zeta is kept. Velocities are linear, so interpolation is exact except in the
// half cell at the walls, where they are continued flat; that half cell's extra flux, slope * cell^2 / 8, is in the expectation.
TEST(OpenStage, StreamlinesOfAShearedLayer) {
  ProjectionOptions o = options();
  o.with_diffusion = false;
  const ProjectionResult r = project_open_stage(channel(shear, 0), kInlet, kOutlet, 400, o, 1, 2);
  ASSERT_EQ(r.landed.size(), 400u);
  EXPECT_EQ(r.stuck + r.lost, 0);
  const double flux = 0.55 * (0.02 * kHeight + 0.05 * kHeight);
  EXPECT_NEAR(r.inlet_flux_m2_s / flux, 1, 1e-9);
  EXPECT_NEAR(r.outlet_flux_m2_s / flux, 1, 1e-9);
  for (const TracerRecord& t : r.landed) {
    EXPECT_NEAR(t.zeta_out, t.zeta_in, 1e-9);
    EXPECT_EQ(t.eta_m, 0);
    // flux quantile q(s) = (0.02 s + 0.05 s^2 + extra) / 0.07 with s = z / H
    const double extra = 0.1 / (20.0 * 20.0 * 8.0);
    const double s = (-0.02 + std::sqrt(0.0004 + 4 * 0.05 * (0.07 * t.zeta_in - extra))) / 0.1;
    if (!(s > 0.03 && s < 0.97)) continue;
    EXPECT_NEAR(t.theta_s * shear(s * kHeight) / kLength, 1, 2e-4);
  }
}

// Plug flow with diffusion: zeta spreads by 2 D_zz t inside, eta by 2 D_xx t, theta is L / u on average: with inlet closed and outlet absorbing the
// mean first-passage time is L / u - D / u^2 (1 - exp(-Pe)), a correction of 1 / Pe = 0.5 %, which is in the expectation.
TEST(OpenStage, PlugFlowWithDiffusion) {
  const double u = 0.05, d = 1e-5, transit = kLength / u;  // Pe = 200
  const ProjectionResult r = project_open_stage(channel([&](double) { return u; }, d), kInlet, kOutlet, 8000, options(), 2, 2);
  ASSERT_EQ(r.landed.size(), 8000u);
  double theta = 0, eta2 = 0;
  std::vector<double> zeta;
  for (const TracerRecord& t : r.landed) {
    theta += t.theta_s / 8000;
    eta2 += t.eta_m * t.eta_m / 8000;
    zeta.push_back(t.zeta_out);
  }
  EXPECT_NEAR(theta / (transit - d / (u * u)), 1, 0.005);  // sampling: sqrt(2 D t) / (u t) / sqrt(N) = 0.11 %, steps of half a cell at the ends
  EXPECT_NEAR(eta2 / (2 * 2 * d * theta), 1, 0.05);        // 2 D_xx t; sampling sqrt(2 / N) = 1.6 %
  // The bed stays full: zeta_out is uniform. Kolmogorov-Smirnov at 99.9 %: 1.95 / sqrt(N).
  std::sort(zeta.begin(), zeta.end());
  double ks = 0;
  for (std::size_t i = 0; i < zeta.size(); ++i) ks = std::max(ks, std::abs(zeta[i] - (static_cast<double>(i) + 0.5) / 8000));
  EXPECT_LT(ks, 1.95 / std::sqrt(8000.0));
}

// Well mixed on a grid: D falls by a factor 10 over the height, phi varies by 20 %, and a uniform feed stays a full bed. Without the drift it does
// not.
TEST(OpenStage, VaryingDiffusivityKeepsTheBedFull) {
  const auto run = [](bool drift) {
    dem::WindowFields f = channel([](double) { return 0.02; }, 0);
    for (int j = 2; j < 22; ++j)
      for (int i = 0; i < 100; ++i) {
        const double s = (j - 1.5) / 20;
        f.solid_fraction[f.grid.index(i, j)] = 0.55 * (1 + 0.1 * std::cos(2 * M_PI * s));
        f.d_zz_m2_s[f.grid.index(i, j)] = 1e-5 * (1 + 0.9 * std::cos(M_PI * s));
      }
    ProjectionOptions o = options();
    o.with_drift = drift;
    const ProjectionResult r = project_open_stage(f, kInlet, kOutlet, 6000, o, 3, 2);
    std::vector<double> bins(10, 0.0);
    for (const TracerRecord& t : r.landed) bins[static_cast<std::size_t>(std::min(9, static_cast<int>(t.zeta_out * 10)))] += 1;
    double worst = 0;
    for (double b : bins) worst = std::max(worst, std::abs(b / 600 - 1));
    return worst;
  };
  EXPECT_LT(run(true), 3.5 / std::sqrt(600.0));  // FP3's limit
  EXPECT_GT(run(false), 0.3);
}

TEST(OpenStage, SameBytesForAnyNumberOfThreadsAndSeedsDiffer) {
  const auto fields = channel(shear, 2e-6);
  const auto run = [&](std::uint64_t seed, int threads) { return project_open_stage(fields, kInlet, kOutlet, 300, options(), seed, threads).landed; };
  const auto same = [](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const TracerRecord& p, const TracerRecord& q) {
      return p.zeta_in == q.zeta_in && p.zeta_out == q.zeta_out && p.theta_s == q.theta_s && p.eta_m == q.eta_m;
    });
  };
  const auto one = run(5, 1);
  EXPECT_TRUE(same(one, run(5, 2)));
  EXPECT_TRUE(same(one, run(5, 5)));
  EXPECT_FALSE(same(one, run(6, 1)));
}

// FP12: colour is passive. Paths do not know it, so with the labels swapped the two colours' landings swap exactly, and so do the transported fields.
TEST(OpenStage, FP12_ColourSwap) {
  const ProjectionResult r = project_open_stage(channel(shear, 2e-6), kInlet, kOutlet, 2000, options(), 7, 2);
  const Operator op = operator_from_landings("channel", landings_of(r, 5, 5), 5, 5, 0.01, 0.2e-3, true);
  Bed bed = make_bed({30, 90, 5, 1e-3, 0}, {"body", "vein"});
  Rng rng(1, stream_id("tests/line/projection"));
  for (auto& powder : bed.mass)
    for (double& m : powder) m = rng.uniform();
  Bed swapped = bed;
  std::swap(swapped.mass[0], swapped.mass[1]);
  const Bed a = apply(op, bed, 0.15, 0, 2), b = apply(op, swapped, 0.15, 0, 2);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < a.mass[k].size(); ++i) ASSERT_NEAR(a.mass[k][i], b.mass[1 - k][i], 1e-14);  // the transform's rounding
}

TEST(OpenStage, CountsTheStuckAndRefusesDeadFields) {
  ProjectionOptions o = options();
  o.max_time_s = 0.9 * kLength / 0.05;
  const auto plug = channel([](double) { return 0.05; }, 0);
  const ProjectionResult r = project_open_stage(plug, kInlet, kOutlet, 50, o, 1, 1);
  EXPECT_EQ(r.stuck, 50);
  EXPECT_TRUE(r.landed.empty());
  EXPECT_THROW(project_open_stage(channel([](double) { return 0.0; }, 1e-6), kInlet, kOutlet, 10, options(), 1, 1), WorkError);
  EXPECT_THROW(project_open_stage(plug, kInlet, kOutlet, 10, ProjectionOptions{}, 1, 1), UsageError);
  EXPECT_THROW(project_open_stage(plug, {0.1, 0, 0.1, kHeight}, kOutlet, 10, options(), 1, 1), WorkError);  // inlet off the grid
}

// A bend: powder enters downwards through a horizontal inlet and leaves sideways. Potential corner flow u = (y, -z) is free of divergence and keeps y
// * z: the lowest streamline comes from next to the wall at y = 0. Inlet quantile counts from its first end.
TEST(OpenStage, CornerFlowTurnsTheBed) {
  dem::WindowFields f = channel(shear, 0);
  f.grid = {0, 0, kCell, 40, 40};
  for (auto* v : {&f.solid_fraction, &f.velocity_y_m_s, &f.velocity_z_m_s, &f.d_xx_m2_s, &f.d_yy_m2_s, &f.d_zz_m2_s, &f.d_yz_m2_s, &f.samples})
    v->assign(f.grid.size(), 0.0);
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i) {
      const std::size_t c = f.grid.index(i, j);
      f.solid_fraction[c] = 0.5;
      f.velocity_y_m_s[c] = (i + 0.5) * kCell;
      f.velocity_z_m_s[c] = -(j + 0.5) * kCell;
    }
  const double side = 40 * kCell, top = side;
  ProjectionOptions o = options();
  const ProjectionResult r = project_open_stage(f, {0, top, side, top}, {side, 0, side, side}, 200, o, 1, 1);
  ASSERT_EQ(r.landed.size(), 200u);
  for (const TracerRecord& t : r.landed) {
    if (t.zeta_in < 0.03 || t.zeta_in > 0.97) continue;     // half cells at the walls
    EXPECT_NEAR(t.zeta_out, t.zeta_in, 0.01);               // y z = const: z_out / side = y_in / side
    EXPECT_NEAR(t.theta_s, std::log(1 / t.zeta_in), 0.03);  // y grows as exp(t)
  }
}

// Noise on the velocities makes sources and sinks: the correction removes them from the face fluxes, and leaves a clean field alone.
TEST(SteadyContinuity, RemovesSourcesAndKeepsCleanFields) {
  const auto clean = channel(shear, 0);
  dem::WindowFields f = clean;
  EXPECT_LT(enforce_steady_continuity(f, kInlet, kOutlet).velocity_change, 1e-12);
  Rng rng(3, stream_id("tests/line/projection/continuity"));
  for (std::size_t c = 0; c < f.grid.size(); ++c)
    if (f.solid_fraction[c] > 0) {
      f.solid_fraction[c] *= 1 + 0.1 * (rng.uniform() - 0.5);
      f.velocity_y_m_s[c] += 0.01 * (rng.uniform() - 0.5);
      f.velocity_z_m_s[c] += 0.01 * (rng.uniform() - 0.5);
    }
  const double noise = 0.01 / std::sqrt(12.0);
  const ContinuityReport report = enforce_steady_continuity(f, kInlet, kOutlet);
  EXPECT_GT(report.defect_before, 1e-3);
  EXPECT_LT(report.defect_after, 1e-10 * report.defect_before);
  EXPECT_NEAR(report.outlet_scale, 1, 0.1);
  double error = 0, count = 0;
  for (std::size_t c = 0; c < f.grid.size(); ++c)
    if (f.solid_fraction[c] > 0) {
      error += std::pow(f.velocity_y_m_s[c] - clean.velocity_y_m_s[c], 2) + std::pow(f.velocity_z_m_s[c], 2);
      count += 2;
    }
  EXPECT_LT(std::sqrt(error / count), 1.01 * noise);  // it must not make the field worse
  EXPECT_THROW(enforce_steady_continuity(f, kInlet, {-0.01, 0, -0.01, kHeight}), WorkError);
}
