#include "line/stages/press/slice.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/rng.h"
#include "line/products/operator.h"
#include "line/response/response_operator.h"

namespace venato::line::press {
namespace {
constexpr double kLoosePacking = 0.52;  // solid fraction of the lattice-filled, settled bed: only sizes the fill and where the lid starts
constexpr int kHeightBins = 6;

double fill_mass(const Config& c, const LineBasics& basics) {
  const double area = c.numerics.slice_width_m * c.numerics.slice_width_m;
  return kLoosePacking * area * c.bed_height_m * basics.materials.materials[LineBasics::kGrain].density_kg_m3;
}
double lid_start(const Config& c) { return 2.6 * c.bed_height_m; }  // above the lattice the grains are laid on, which is looser still
double lid_end(const Config& c) { return c.bed_height_m * kLoosePacking / c.end_solid_fraction; }
}  // namespace

dem::Case make_case(const Config& c, const LineBasics& basics) {
  const double width = c.numerics.slice_width_m;
  dem::Case s = make_slice_case(basics, "press slice", c.numerics, {basics.body_powder}, 0, width, -0.002, lid_start(c) + 0.004);
  s.box.periodic[1] = true;
  s.law = dem::LawKind::eepa;
  s.eepa.stiffness_ratio_k2_k1 = c.stiffness_ratio;
  s.eepa.adhesion_ratio_kadh_k1 = c.adhesion_ratio;
  dem::Wall floor;
  floor.name = "floor";
  floor.shape = dem::PlaneShape{Vec3::Zero(), Vec3::UnitZ()};
  floor.material = LineBasics::kSteel;
  dem::Wall lid;
  lid.name = "lid";
  lid.shape = dem::PlaneShape{Vec3(0, 0, lid_start(c)), -Vec3::UnitZ()};
  lid.material = LineBasics::kSteel;
  const double travel = lid_start(c) - lid_end(c), press_s = travel / c.lid_speed_m_s;
  lid.motion.track = {{0, Vec3::Zero()}, {c.settle_s, Vec3::Zero()}, {c.settle_s + press_s, Vec3(0, 0, -travel)}};
  s.walls = {floor, lid};
  dem::Fill fill;
  fill.low = Vec3(0, 0, 0.0002);
  fill.high = Vec3(width, width, lid_start(c) - 0.0005);
  fill.powder_mass_fractions = {1.0};
  fill.mass_kg = fill_mass(c, basics);
  s.fills.push_back(fill);
  s.duration_s = c.settle_s + press_s;
  s.series.every_s = press_s / 60;
  // One frame each: just before the lid moves and just before it stops.
  s.snapshots.push_back({0.98 * c.settle_s, c.settle_s, s.duration_s});
  s.snapshots.push_back({c.settle_s + 0.998 * press_s, s.duration_s, s.duration_s});
  return s;
}

NonAffine non_affine_scatter(const dem::Snapshot& before, const dem::Snapshot& after, int height_bins) {
  std::map<std::int64_t, std::size_t> late;
  for (std::size_t k = 0; k < after.id.size(); ++k) late.emplace(after.id[k], k);
  double top0 = 0, top1 = 0;
  for (const Vec3& p : before.position_m) top0 = std::max(top0, p.z());
  for (const Vec3& p : after.position_m) top1 = std::max(top1, p.z());
  struct Sum {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0;
  };
  std::vector<Sum> bins(static_cast<std::size_t>(height_bins));
  for (std::size_t k = 0; k < before.id.size(); ++k) {
    const auto it = late.find(before.id[k]);
    if (it == late.end()) continue;
    const Vec3 d = after.position_m[it->second] - before.position_m[k];
    auto& b = bins[std::min(bins.size() - 1, static_cast<std::size_t>(before.position_m[k].z() / top0 * height_bins))];
    b.n += 1, b.x += d.x(), b.y += d.y(), b.xx += d.x() * d.x(), b.yy += d.y() * d.y();
  }
  double n = 0, vx = 0, vy = 0;
  for (const Sum& b : bins) {
    if (b.n < 2) continue;
    n += b.n - 1;
    vx += b.xx - b.x * b.x / b.n;
    vy += b.yy - b.y * b.y / b.n;
  }
  if (!(n > 0) || !(top0 > 0)) throw WorkError("press: the DEM slice holds too few grains to measure their scatter");
  return {std::sqrt(vx / n), std::sqrt(vy / n), 1 - top1 / top0};
}

Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& folder, Context& context) {
  const dem::Case slice = make_case(c, basics);
  const dem::CaseResult r = run_slice(slice, folder / "press.ckpt", context);
  if (r.snapshots.size() < 2 || r.snapshots[0].empty() || r.snapshots[1].empty())
    throw WorkError("press: the DEM slice ended without its two frames");
  const NonAffine scatter = non_affine_scatter(r.snapshots[0].front(), r.snapshots[1].front(), kHeightBins);
  const double cg = c.numerics.coarse_graining;
  // Scatter scales with the grain (sigma^2 = C d^2 strain, multiscale.md 3.3): real grains scatter cg times less.
  const double sigma = std::sqrt(0.5 * (scatter.sd_x_m * scatter.sd_x_m + scatter.sd_y_m * scatter.sd_y_m)) / cg;

  // Kernel: the two-dimensional normal law of that scatter, sampled finely enough that its moments are exact to 1e-4.
  std::vector<Landing> landings;
  const int half = 12;
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j) {
      const double a = 4.0 * i / half, b = 4.0 * j / half;
      landings.push_back({0, 0, a * sigma / basics.belt_speed_m_s, b * sigma, std::exp(-0.5 * (a * a + b * b))});
    }
  const double bin = std::max(sigma / 3, basics.grid.pitch_m / 16);
  Operator op = operator_from_landings("press", landings, 1, 1, bin / basics.belt_speed_m_s, bin, false);

  const double d = mean_grain_m(basics, basics.body_powder, cg);
  op.figures["sigma_nonaffine_m"] = sigma;
  op.figures["nonaffine_coefficient"] = sigma * sigma * cg * cg / (d * d * scatter.strain);
  op.figures["height_strain"] = scatter.strain;

  // Lid pressure against solid fraction from the series.
  const double area = slice.box.high.x() * slice.box.high.y(), solid = r.mass_left_kg / basics.materials.materials[LineBasics::kGrain].density_kg_m3;
  const double press_s = slice.duration_s - c.settle_s, travel = lid_start(c) - lid_end(c);
  std::vector<double> fraction, pressure;
  for (std::size_t k = 0; k < r.series.time_s.size(); ++k) {
    const double t = r.series.time_s[k] - c.settle_s;
    if (t <= 0 || r.series.wall_force_n.size() < 2) continue;
    const double z = lid_start(c) - travel * std::min(1.0, t / press_s);
    const double p = std::abs(r.series.wall_force_n[1][k].z()) / area;
    fraction.push_back(solid / (area * z));
    pressure.push_back(p);
  }
  op.curves["pressure against solid fraction"] = {{"solid_fraction", fraction}, {"pressure_pa", pressure}};
  if (!pressure.empty()) {
    op.figures["lid_pressure_end_pa"] = pressure.back();
    const double rate = c.lid_speed_m_s / (lid_end(c));
    op.figures["inertial_number"] =
        rate * d * std::sqrt(basics.materials.materials[LineBasics::kGrain].density_kg_m3 / std::max(pressure.back(), 1.0));
  }
  add_slice_figures(slice, r, op);
  return op;
}
}  // namespace venato::line::press
