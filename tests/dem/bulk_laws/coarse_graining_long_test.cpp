// How far coarse graining may be pushed: the same hopper, the same residual slope and the same belt under a gate with grains cg times as large,
// several seeds each. dem/coarse_graining.md gives the table that this prints and the rule drawn from it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <numbers>

#include "base/store/store.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/fields/field_recorder.h"
#include "tests/dem/bulk_laws/powder_scenes.h"

namespace venato::dem::bulk {
namespace {
constexpr int kSeeds = 3;
constexpr double kFactors[] = {1, 2, 3, 4};
constexpr double kDepth = 12 * kD;  // periodic x
constexpr double kSlot = 12 * kD, kSiloWidth = 40 * kD;
constexpr double kGate = 8 * kD, kBeltSpeed = 0.25;

CaseResult run(Case& c) {
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  const auto folder = std::filesystem::temp_directory_path() / ("venato_coarse_graining_" + std::to_string(::getpid()));
  Store store(folder);
  Context context{*log, *progress, store, c.seed, 2, nullptr};
  CaseResult r = run_case(c, {}, context);
  std::filesystem::remove_all(folder);
  return r;
}
Case base_case(const char* name, double cg, std::uint64_t seed, double y_length, double height) {
  Case c;
  c.name = name;
  c.box = {Vec3(0, 0, -4 * kD), Vec3(kDepth, y_length, height), {true, false, false}};
  c.gravity_m_s2 = Vec3(0, 0, -kGravity);
  c.materials = powder(.5, .1, .5);
  c.powders = {{"powder", {kD, 3, 0.9 * kD, 1.1 * kD}, 0}};
  c.coarse_graining = cg;
  c.expected_max_speed_m_s = 2;
  c.seed = seed;
  return c;
}
Wall profile(const char* name, const std::vector<std::pair<double, double>>& yz_m, double off_s = 1e9) {
  Wall w = wall(extrude_profile(yz_m, 0, kDepth));
  w.name = name;
  w.present.off_s = off_s;
  return w;
}
/// Mass of `diameters` of height of a bed over the depth and `length`.
double bed_mass(double length_m, double height_m) { return 0.58 * kDensity * kDepth * length_m * height_m; }

/// Mean flow while 5 to 40 % of `all` crosses: before, the slot is opening; later, the level and the side slopes run down.
double early_flow(const std::vector<CounterRecord>& records, double all) {
  double mass = 0, from = 0;
  for (const CounterRecord& r : records) {
    if (mass < 0.05 * all) from = r.time_s;
    mass += r.mass_kg;
    if (mass > 0.4 * all) return (mass - 0.05 * all) / (r.time_s - from);
  }
  return std::nan("");
}

struct Hopper {
  double flow_kg_s, slope_deg;
};
/// Flat-bottomed hopper with a slot, until it runs dry; then the slopes that stay on both half floors, from the mean height of their grains
/// (a wedge of length L and slope t has L t / 3), which needs no surface.
Hopper hopper(double cg, std::uint64_t seed) {
  const double open = 0.5;
  Case c = base_case("hopper", cg, seed, kSiloWidth, 90 * kD);
  const double left = 0.5 * (kSiloWidth - kSlot), right = 0.5 * (kSiloWidth + kSlot);
  c.walls = {profile("left", {{0, 90 * kD}, {0, 0}, {left, 0}}), profile("right", {{kSiloWidth, 90 * kD}, {kSiloWidth, 0}, {right, 0}}),
             profile("plug", {{left, 0}, {right, 0}}, open)};
  for (Wall& w : c.walls) w.material = 1;
  c.fills = {{Vec3(0, 0.1 * kD, 0.1 * kD), Vec3(kDepth, kSiloWidth - 0.1 * kD, 89 * kD), {1}, bed_mass(kSiloWidth, 28 * kD), Vec3::Zero()}};
  c.counters = {{"slot", 2, -0.5 * kD, -1, Vec3::Constant(-1), Vec3::Constant(1), true, true}};
  c.duration_s = 2.4;
  c.series.every_s = 0.05;
  const CaseResult r = run(c);
  double z = 0, m = 0;
  for (const GrainRecord& g : r.final_state) z += std::pow(g.diameter_m, 3) * g.position_m.z(), m += std::pow(g.diameter_m, 3);
  return {early_flow(r.records[0], r.mass_put_in_kg), std::atan(3 * z / m / left) * 180 / std::numbers::pi};
}

struct Belt {
  double flow_kg_s, areal_mass_kg_m2, thickness_m;
};
/// A bin on a belt that draws a bed out under a gate: throughput, mass per area and thickness (half the density of the bed's middle) downstream.
Belt belt(double cg, std::uint64_t seed) {
  const double start = 0.4, gate_y = 16 * kD, length = 60 * kD;
  Case c = base_case("belt", cg, seed, length, 90 * kD);
  Wall floor = plane(Vec3::Zero(), Vec3::UnitZ());
  floor.name = "belt";
  floor.motion.surface_velocity_m_s = Vec3(0, kBeltSpeed, 0);
  Wall still = plane(Vec3::Zero(), Vec3::UnitZ());
  still.name = "still";
  still.present.off_s = start, floor.present.on_s = start;
  c.walls = {still, floor, profile("back", {{0, 90 * kD}, {0, 0}}), profile("gate", {{gate_y, 90 * kD}, {gate_y, kGate}}),
             profile("shut", {{gate_y, kGate}, {gate_y, 0}}, start)};
  for (Wall& w : c.walls) w.material = 1;
  c.fills = {{Vec3(0, 0.1 * kD, 0.1 * kD), Vec3(kDepth, gate_y - 0.1 * kD, 89 * kD), {1}, bed_mass(gate_y, 40 * kD), Vec3::Zero()}};
  c.counters = {{"end", 1, 50 * kD, 1, Vec3::Constant(-1), Vec3::Constant(1), true, true}};
  // At cg 4 the gap is two grains high: some packings jam in it, the belt squeezes them by a quarter of a radius, and one shoots out at 4 m/s.
  c.expected_max_speed_m_s = 5;
  c.duration_s = 1.6;
  c.series.every_s = 0.05;
  FieldPlan plan;
  plan.width_m = 0.5 * cg * kD, plan.cell_m = Vec3(kDepth, 2 * kD, 0.5 * kD);
  plan.from_s = 1.15, plan.to_s = 1.6, plan.every_s = 0.02;
  c.fields = plan;
  const CaseResult r = run(c);
  const ContinuumFields& f = r.fields->fields;
  std::vector<double> phi(static_cast<std::size_t>(f.grid.n[2]), 0);
  double columns = 0;
  for (int j = 0; j < f.grid.n[1]; ++j) {
    if (f.grid.centre_m(1, j) < 25 * kD || f.grid.centre_m(1, j) > 45 * kD) continue;
    columns += 1;
    for (int k = 0; k < f.grid.n[2]; ++k) phi[static_cast<std::size_t>(k)] += f.solid_fraction[f.grid.index(0, j, k)];
  }
  Belt b{0, 0, 0};
  std::vector<double> middle;
  for (std::size_t k = 0; k < phi.size(); ++k) {
    phi[k] /= columns;
    b.areal_mass_kg_m2 += phi[k] * kDensity * f.grid.cell_m.z();
    const double z = f.grid.centre_m(2, static_cast<int>(k));
    if (z > 2 * kD && z < 5 * kD) middle.push_back(phi[k]);
  }
  double dense = 0;
  for (const double p : middle) dense += p / static_cast<double>(middle.size());
  for (std::size_t k = 0; k + 1 < phi.size(); ++k)
    if (phi[k] >= 0.5 * dense && phi[k + 1] < 0.5 * dense)
      b.thickness_m = f.grid.centre_m(2, static_cast<int>(k)) + f.grid.cell_m.z() * (phi[k] - 0.5 * dense) / (phi[k] - phi[k + 1]);
  b.flow_kg_s = b.areal_mass_kg_m2 * kDepth * kBeltSpeed;
  return b;
}

struct Mean {
  double value = 0, error = 0;  ///< standard error over the seeds
};
template <class F>
std::vector<Mean> means(std::size_t quantities, int seeds, const F& run_one) {
  std::vector<std::vector<double>> all(quantities);
  for (int seed = 1; seed <= seeds; ++seed) {
    const std::vector<double> one = run_one(static_cast<std::uint64_t>(seed));
    for (std::size_t q = 0; q < quantities; ++q) all[q].push_back(one[q]);
  }
  std::vector<Mean> out;
  for (const auto& v : all) {
    Mean m;
    for (const double x : v) m.value += x / seeds;
    for (const double x : v) m.error += (x - m.value) * (x - m.value);
    m.error = std::sqrt(m.error / (seeds - 1) / seeds);
    out.push_back(m);
  }
  return out;
}

TEST(CoarseGraining, slot_flow_falls_as_beverloo_with_the_coarse_diameter_and_short_slopes_steepen) {
  std::vector<std::vector<Mean>> table;
  for (const double cg : kFactors) {
    table.push_back(means(2, kSeeds, [&](std::uint64_t seed) {
      const Hopper h = hopper(cg, seed);
      return std::vector<double>{h.flow_kg_s, h.slope_deg};
    }));
    const auto& row = table.back();
    std::printf("cg %.0f: slot / d' %.1f, flow %.4f +- %.4f kg/s, slope %.2f +- %.2f deg\n", cg, kSlot / (cg * kD), row[0].value, row[0].error,
                row[1].value, row[1].error);
  }
  // Beverloo with the coarse diameter. k = 2.1 is this powder's (beverloo_long_test.cpp); 1.4, which is right for grains that roll freely, promises
  // too much flow. The law holds from 6 d' on: cg 2 is there; 3 and 4 only have to lose more.
  const double b = kSlot / kD;
  const auto law = [&](double cg, double k) { return std::pow((b - k * cg) / (b - k), 1.5); };
  for (std::size_t q = 1; q < table.size(); ++q) {
    const double ratio = table[q][0].value / table[0][0].value;
    std::printf("cg %.0f: flow ratio %.3f, Beverloo %.3f (k = 1.4), %.3f (k = 2.1)\n", kFactors[q], ratio, law(kFactors[q], 1.4),
                law(kFactors[q], 2.1));
    EXPECT_LT(table[q][0].value, 0.95 * table[q - 1][0].value) << "cg " << kFactors[q];
    EXPECT_LT(ratio, law(kFactors[q], 1.4)) << "cg " << kFactors[q];
  }
  EXPECT_NEAR(table[1][0].value / table[0][0].value / law(2, 2.1), 1, 0.08);  // two means of three runs of about 2 % each, and k to 0.1
  // Slopes of 14 d: 14, 7, 4.7 and 3.5 coarse grains long. Seven still stand within 5 deg, fewer do not.
  EXPECT_NEAR(table[1][1].value, table[0][1].value, 5);
  EXPECT_GT(table[3][1].value, table[0][1].value + 5);
}
TEST(CoarseGraining, bed_under_a_gate_lacks_one_coarse_diameter) {
  std::vector<std::vector<Mean>> table;
  for (const double cg : kFactors) {
    table.push_back(means(3, cg >= 3 ? 4 * kSeeds : kSeeds, [&](std::uint64_t seed) {
      const Belt r = belt(cg, seed);
      return std::vector<double>{r.flow_kg_s, r.areal_mass_kg_m2, r.thickness_m};
    }));
    const auto& row = table.back();
    std::printf("cg %.0f: gate / d' %.1f, flow %.4f +- %.4f kg/s, areal mass %.3f +- %.3f kg/m2, thickness %.2f +- %.2f d\n", cg, kGate / (cg * kD),
                row[0].value, row[0].error, row[1].value, row[1].error, row[2].value / kD, row[2].error / kD);
  }
  EXPECT_GT(table[0][2].value, 0.8 * kGate);
  EXPECT_LT(table[0][2].value, kGate);
  // A layer of one coarse diameter is missing from the bed: mass ~ gate - d'. At 2 d' the gate holds more back.
  const double h = kGate / kD;
  for (std::size_t q = 1; q < table.size(); ++q) {
    const double ratio = table[q][1].value / table[0][1].value, law = (h - kFactors[q]) / (h - 1);
    std::printf("cg %.0f: bed mass ratio %.3f, (gate - d') law %.3f\n", kFactors[q], ratio, law);
    if (kFactors[q] <= 3)
      EXPECT_NEAR(ratio / law, 1, 0.05) << "cg " << kFactors[q];
    else  // some packings jam for a while
      EXPECT_LT(ratio + 2 * table[q][1].error / table[0][1].value, law);
  }
}
}  // namespace
}  // namespace venato::dem::bulk
