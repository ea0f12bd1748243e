#include "line/projection/open_stage.h"

#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/rng.h"
#include "line/projection/flux_profile.h"
#include "line/projection/grid_field.h"
#include "line/projection/steady_continuity.h"

namespace venato::line {
namespace {
constexpr double kNoiseShare = 0.25;       // sqrt(2 D tau) <= 0.25 min(d, D / |grad D|) (multiscale.md 1.4)
constexpr double kAdvectionShare = 0.5;    // |u| tau <= 1/2 cell
constexpr double kShortestLength = 0.05;   // of d: where D fades to nothing the rule would stop time; the jump left there is < 2 % of a grain
constexpr double kLongestStep = 1.0 / 50;  // of max_time: where nothing moves
constexpr int kMostFaces = 64;             // faces met in one step; more means a tracer caught in a corner

enum class Fate { inside, landed, lost };

struct Walker {
  const GridField& field;
  const FluxProfile &inlet, &outlet;
  int i = 0, j = 0;  // cell: kept, so that a point exactly on a face is never ambiguous

  // Share of the way from (y, z) by (dy, dz) where the profile's segment is crossed against `sign`; > 1 = not.
  static double crossing(const FluxProfile& p, double y, double z, double dy, double dz, double sign) {
    const double before = sign * p.ahead_m(y, z), after = sign * p.ahead_m(y + dy, z + dz);
    if (!(before <= 0 && after > 0)) return 2;
    const double t = before / (before - after), s = p.along_m(y + t * dy, z + t * dz);
    return s >= 0 && s <= p.length_m ? t : 2;
  }

  // Moves the tracer cell by cell; unknown cells, the border and the inlet (from inside) reflect. `share` of the displacement had been travelled at
  // the outlet.
  Fate move(Tracer& t, double dy, double dz, double& share) {
    share = 1;
    double left = 1;  // of the original displacement
    for (int met = 0; met < kMostFaces; ++met) {
      const double face_y = field.left_edge_m(i + (dy > 0)), face_z = field.lower_edge_m(j + (dz > 0));
      const double t_y = dy != 0 ? std::max(0.0, (face_y - t.y) / dy) : 2, t_z = dz != 0 ? std::max(0.0, (face_z - t.z) / dz) : 2;
      const double t_face = std::min({t_y, t_z, 1.0});
      const double out = crossing(outlet, t.y, t.z, dy, dz, 1), in = crossing(inlet, t.y, t.z, dy, dz, -1);
      if (out <= t_face + 1e-9 && out <= in) {
        t.y += out * dy;
        t.z += out * dz;
        share = 1 - left * (1 - out);
        return Fate::landed;
      }
      if (in <= t_face) {
        t.y += in * dy;
        t.z += in * dz;
        const double back = 2 * (dy * inlet.normal_y + dz * inlet.normal_z);  // < 0
        dy = (1 - in) * (dy - back * inlet.normal_y);
        dz = (1 - in) * (dz - back * inlet.normal_z);
        left *= 1 - in;
        nudge_off_inlet(t);
        continue;
      }
      t.y += t_face * dy;
      t.z += t_face * dz;
      left *= 1 - t_face;
      if (t_face >= 1) return Fate::inside;
      dy *= 1 - t_face;
      dz *= 1 - t_face;
      if (t_y <= t_z) {
        if (field.inside(i + (dy > 0 ? 1 : -1), j))
          i += dy > 0 ? 1 : -1;
        else
          dy = -dy;
      } else {
        if (field.inside(i, j + (dz > 0 ? 1 : -1)))
          j += dz > 0 ? 1 : -1;
        else
          dz = -dz;
      }
    }
    return Fate::lost;
  }
  void nudge_off_inlet(Tracer& t) const {  // rounding may leave it a hair behind the line
    const double behind = -inlet.ahead_m(t.y, t.z);
    if (behind >= 0) {
      t.y += (behind + 1e-12 * field.cell_m()) * inlet.normal_y;
      t.z += (behind + 1e-12 * field.cell_m()) * inlet.normal_z;
    }
  }
};

double step_length(const GridField::Sample& here, const ProjectionOptions& o, double cell_m) {
  double tau = std::min(o.max_step_s, kLongestStep * o.max_time_s);
  const double d = std::max(here.d_yy, here.d_zz);
  if (d > 0) {
    double length = o.grain_diameter_m;
    if (here.gradient_of_d > 0) length = std::min(length, std::max(d / here.gradient_of_d, kShortestLength * o.grain_diameter_m));
    const double jump = kNoiseShare * length;
    tau = std::min(tau, jump * jump / (2 * d));
  }
  const double speed = std::hypot(here.u_y, here.u_z) + std::hypot(here.drift_y, here.drift_z);
  if (speed > 0) tau = std::min(tau, kAdvectionShare * cell_m / speed);
  return tau * o.step_factor;
}

struct Outcome {
  Fate fate = Fate::inside;
  TracerRecord record{};
  std::int64_t steps = 0;
};

Outcome carry_through(const GridField& field, const FluxProfile& inlet, const FluxProfile& outlet, const ProjectionOptions& o, std::uint64_t seed,
                      int tracer, int n_tracers) {
  Outcome outcome;
  Rng rng(seed, stream_id("line/projection"), static_cast<std::uint64_t>(tracer));
  // One tracer per equal share of the inlet's flux, anywhere inside its share.
  outcome.record.zeta_in = (tracer + rng.uniform()) / n_tracers;
  const double s = inlet.position_at(outcome.record.zeta_in), off = 1e-6 * field.cell_m();
  Tracer t{inlet.segment.y0_m + s * inlet.along_y + off * inlet.normal_y, inlet.segment.z0_m + s * inlet.along_z + off * inlet.normal_z, 0, 0};
  Walker walker{field, inlet, outlet, field.column_of(t.y), field.row_of(t.z)};
  if (!field.inside(walker.i, walker.j)) {
    outcome.fate = Fate::lost;
    return outcome;
  }
  while (t.time_s < o.max_time_s) {
    GridField::Sample here = field.sample(t.y, t.z);
    const double tau = step_length(here, o, field.cell_m());
    if (!o.with_drift) here.drift_y = here.drift_z = 0;
    if (!o.with_diffusion) here.d_xx = here.d_yy = here.d_zz = here.d_yz = here.drift_y = here.drift_z = 0;
    const double a = rng.normal(), b = rng.normal();
    double dy, dz, share;
    propose_step(field, here, t, tau, {a, b}, dy, dz);
    outcome.fate = walker.move(t, dy, dz, share);
    t.time_s += share * tau;
    t.spread_x_m2 += 2 * here.d_xx * share * tau;
    ++outcome.steps;
    if (outcome.fate == Fate::landed) {
      outcome.record.zeta_out = outlet.quantile_at(outlet.along_m(t.y, t.z));
      outcome.record.theta_s = t.time_s;
      outcome.record.eta_m = std::sqrt(t.spread_x_m2) * Rng(seed, stream_id("line/projection/across"), static_cast<std::uint64_t>(tracer)).normal();
    }
    if (outcome.fate != Fate::inside) break;
  }
  return outcome;
}
}  // namespace

ProjectionResult project_open_stage(const dem::WindowFields& measured, const Segment& inlet_segment, const Segment& outlet_segment, int n_tracers,
                                    const ProjectionOptions& options, std::uint64_t seed, int threads) {
  if (!(options.grain_diameter_m > 0) || !(options.max_time_s > 0) || !(options.max_step_s > 0) || !(options.step_factor > 0) || n_tracers < 1)
    throw UsageError("projection needs positive grain_diameter_m (" + std::to_string(options.grain_diameter_m) + "), max_time_s (" +
                     std::to_string(options.max_time_s) + "), max_step_s, step_factor and number of tracers (" + std::to_string(n_tracers) + ")");
  dem::WindowFields fields = measured;
  if (options.steady_continuity) enforce_steady_continuity(fields, inlet_segment, outlet_segment);
  const GridField field(fields);
  const FluxProfile inlet = flux_profile(field, inlet_segment, SegmentRole::inlet), outlet = flux_profile(field, outlet_segment, SegmentRole::outlet);

  std::vector<Outcome> outcomes(static_cast<std::size_t>(n_tracers));
#pragma omp parallel for num_threads(threads) schedule(dynamic, 64)
  for (int i = 0; i < n_tracers; ++i) outcomes[static_cast<std::size_t>(i)] = carry_through(field, inlet, outlet, options, seed, i, n_tracers);

  ProjectionResult result;
  result.tracers = n_tracers;
  result.inlet_flux_m2_s = inlet.net_m2_s;
  result.outlet_flux_m2_s = outlet.net_m2_s;
  std::int64_t steps = 0;
  for (const Outcome& o : outcomes) {
    steps += o.steps;
    if (o.fate == Fate::landed) result.landed.push_back(o.record);
    result.stuck += o.fate == Fate::inside;
    result.lost += o.fate == Fate::lost;
  }
  result.mean_steps = static_cast<double>(steps) / n_tracers;
  return result;
}

std::vector<Landing> landings_of(const ProjectionResult& result, int nz_in, int nz_out) {
  const auto layer = [](double zeta, int n) { return std::clamp(static_cast<int>(zeta * n), 0, n - 1); };
  std::vector<Landing> landings;
  landings.reserve(result.landed.size());
  for (const TracerRecord& r : result.landed) landings.push_back({layer(r.zeta_in, nz_in), layer(r.zeta_out, nz_out), r.theta_s, r.eta_m, 1});
  return landings;
}
}  // namespace venato::line
