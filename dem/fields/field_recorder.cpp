#include "dem/fields/field_recorder.h"

#include <algorithm>
#include <cmath>

#include "dem/fields/continuum_balance.h"

namespace venato::dem {
namespace {
constexpr int kScanSteps = 10;  // of sqrt(2), from an eighth to four times

/// x and y averaged over; cells of half a width, whose mean adds 1 % to the kernel's width.
ContinuumGrid profile_grid(const Box& box, double width_m, double cell_m) {
  return make_continuum_grid(box, Vec3(box.high.x() - box.low.x(), box.high.y() - box.low.y(), cell_m), width_m);
}
std::vector<ContinuumSums> scan_of(const Box& box, double width_m) {
  std::vector<ContinuumSums> scan;
  const std::vector<double> widths = plateau_widths(width_m);
  for (const double w : widths) scan.emplace_back(profile_grid(box, w, 0.5 * w));
  return scan;
}

/// Linear between the centres of the cells of a profile.
struct HeightLookup {
  HeightLookup(const ContinuumGrid& grid, double z_m) {
    const double last = std::max(0.0, grid.n[2] - 1.0), g = std::clamp((z_m - grid.low.z()) / grid.cell_m.z() - 0.5, 0.0, last);
    below = static_cast<std::size_t>(g);
    above = std::min(below + 1, static_cast<std::size_t>(last));
    share = g - static_cast<double>(below);
  }
  template <class F>
  double of(const F& f) const {
    return above == below ? f(below) : (1 - share) * f(below) + share * f(above);
  }
  std::size_t below, above;
  double share;
};

WindowFields diffusivity_of(const Box& box, const FieldPlan& plan, double coarse_graining, const std::vector<Snapshot>& frames) {
  const Vec3 size = box.high - box.low;
  const int ny = std::max(1, static_cast<int>(std::lround(size.y() / std::min(plan.cell_m.y(), plan.cell_m.z()))));
  FieldGrid grid{box.low.y(), box.low.z(), size.y() / ny, ny, 0};
  grid.nz = std::max(1, static_cast<int>(std::ceil(size.z() / grid.cell_m)));
  FieldOptions options;
  options.slice_width_m = size.x();
  options.coarse_graining = coarse_graining;
  options.periodic_y = box.periodic[1];
  options.max_lag_s = plan.to_s - plan.from_s;
  return estimate_fields(frames, grid, options);
}
}  // namespace

std::vector<double> plateau_widths(double width_m) {
  std::vector<double> widths;
  for (int k = 0; k <= kScanSteps; ++k) widths.push_back(width_m / 8 * std::pow(2.0, 0.5 * k));
  return widths;
}

Snapshot snapshot_of(const Simulation& sim) {
  Snapshot s;
  s.time_s = sim.time_s();
  for (const GrainState& g : sim.grains()) {
    s.id.push_back(g.id);
    s.position_m.push_back(g.position_m);
    s.velocity_m_s.push_back(g.velocity_m_s);
    s.radius_m.push_back(static_cast<float>(g.radius_m));
    s.species.push_back(g.species);
  }
  return s;
}

FieldRecorder::FieldRecorder(const Box& box, const FieldPlan& plan, const Vec3& gravity, double coarse_graining)
    : box_(box),
      plan_(plan),
      gravity_(gravity),
      coarse_graining_(coarse_graining),
      sums_(make_continuum_grid(box, plan.cell_m, plan.width_m)),
      scan_(scan_of(box, plan.width_m)) {}

void FieldRecorder::take(const Simulation& sim) {
  const std::vector<GrainState> grains = sim.grains();
  const std::vector<ContactState> contacts = sim.contacts();
  sums_.add(grains, contacts);
  for (ContinuumSums& s : scan_) s.add(grains, contacts);
  const MomentumBalance b = momentum_balance(sums_.grid(), grains, contacts, gravity_);
  balance_residual_ = b.largest_term > 0 ? b.largest_residual / b.largest_term : 0;
  if (plan_.diffusivity) frames_.push_back(snapshot_of(sim));
}

FieldResult FieldRecorder::finish() const {
  FieldResult r;
  r.fields = continuum_fields(sums_);
  r.balance_residual = balance_residual_;
  double mass = 0, height = 0;
  const ContinuumGrid& fine = scan_.front().grid();
  for (int k = 0; k < fine.n[2]; ++k) {
    const double m = scan_.front().cells()[static_cast<std::size_t>(k)].mass;
    mass += m, height += m * fine.centre_m(2, k);
  }
  r.plateau.z_m = mass > 0 ? height / mass : 0.5 * (box_.low.z() + box_.high.z());
  for (const ContinuumSums& s : scan_) {
    const ContinuumFields f = continuum_fields(s);
    const HeightLookup at(f.grid, r.plateau.z_m);
    r.plateau.width_m.push_back(f.grid.width_m);
    r.plateau.density_kg_m3.push_back(at.of([&](std::size_t c) { return f.density_kg_m3[c]; }));
    r.plateau.stress_zz_pa.push_back(at.of([&](std::size_t c) { return f.kinetic_stress_pa[c][8] + f.contact_stress_pa[c][8]; }));
    r.plateau.temperature_m2_s2.push_back(at.of([&](std::size_t c) { return f.temperature_m2_s2[c]; }));
  }
  if (plan_.diffusivity && frames_.size() >= 3) r.diffusivity = diffusivity_of(box_, plan_, coarse_graining_, frames_);
  return r;
}
}  // namespace venato::dem
