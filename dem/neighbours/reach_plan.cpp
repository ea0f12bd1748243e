#include "dem/neighbours/reach_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"

namespace venato::dem {
namespace {
// Allowances in radii: what the plan aims at for a typical grain, and the least (rounding, vibration of a resting bed).
constexpr double kAim = 0.14, kLeast = 0.02;
constexpr double kFast = 3;                       // faster than this many rms: flies on its own path
constexpr double kShear = 0.25;                   // part of the velocity difference between neighbouring cells that counts as fluctuation
constexpr double kMostFall = 0.1;                 // of a radius: what gravity may do within one life
constexpr double kShortest = 8, kLongest = 2000;  // steps
constexpr double kCellDiameters = 4;              // edge of the cells that velocities are averaged over
constexpr double kMostPeriodic = 0.245;           // of a periodic length: a grain's reach, so that images cannot be confused

struct FlowCell {
  Trio mean;
  double rms = 0, contrast = 0;  ///< contrast: largest difference of means to a neighbouring cell
  std::int32_t count = 0;
};

/// Mean and fluctuation of the velocity in cubes; cubes farther apart than one cube never matter (see far_enough).
class FlowGrid {
 public:
  FlowGrid(const ReachInput& in, double edge) : cell_of_(in.spheres.size()) {
    double low[3], high[3];
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::numeric_limits<double>::infinity(), high[a] = -low[a];
    for (const Sphere& s : in.spheres) {
      const double p[3] = {s.x, s.y, s.z};
      for (std::size_t a = 0; a < 3; ++a)
        if (std::isfinite(p[a])) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
    }
    const double most = static_cast<double>(in.spheres.size()) + 4096;
    for (;; edge *= 1.3) {
      double product = 1;
      for (std::size_t a = 0; a < 3; ++a) {
        periodic_[a] = in.box.length[a] > 0;
        origin_[a] = periodic_[a] ? in.box.low[a] : low[a];
        const double extent = periodic_[a] ? in.box.length[a] : std::max(0.0, high[a] - low[a]);
        const double n = std::clamp(std::floor(extent / edge), 1.0, 1e6);
        edge_[a] = std::max(extent / n, 1e-300);
        count_[a] = static_cast<std::int64_t>(n);
        product *= n;
      }
      if (product <= most) break;
    }
    cells_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    const std::int64_t grains = static_cast<std::int64_t>(in.spheres.size());
#pragma omp parallel for schedule(static) num_threads(in.threads) if (in.threads > 1)
    for (std::int64_t k = 0; k < grains; ++k) {
      const Sphere& s = in.spheres[static_cast<std::size_t>(k)];
      cell_of_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>((along(2, s.z) * count_[1] + along(1, s.y)) * count_[0] + along(0, s.x));
    }
    for (std::size_t k = 0; k < in.spheres.size(); ++k) {  // in order: the same sums for any number of threads
      FlowCell& c = cells_[static_cast<std::size_t>(cell_of_[k])];
      c.mean = c.mean + in.velocity[k];
      ++c.count;
    }
    for (FlowCell& c : cells_)
      if (c.count > 0) c.mean = (1.0 / c.count) * c.mean;
    for (std::size_t k = 0; k < in.spheres.size(); ++k) {
      FlowCell& c = cells_[static_cast<std::size_t>(cell_of_[k])];
      const Trio dv = in.velocity[k] - c.mean;
      c.rms += dot(dv, dv);
    }
    for (FlowCell& c : cells_)
      if (c.count > 0) c.rms = std::sqrt(c.rms / c.count);
    contrasts();
  }
  const FlowCell& at(std::size_t grain) const { return cells_[static_cast<std::size_t>(cell_of_[grain])]; }
  /// Spheres that come as far as `reach` cannot meet one from beyond the neighbouring cells.
  bool far_enough(double reach) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (count_[a] > 3 - (periodic_[a] ? 0 : 1) && 2 * reach > edge_[a]) return false;
    return true;
  }

 private:
  std::int64_t along(std::size_t a, double v) const {
    const double k = std::floor((v - origin_[a]) / edge_[a]);
    return k > 0 ? static_cast<std::int64_t>(std::min(k, static_cast<double>(count_[a] - 1))) : 0;  // NaN: 0
  }
  void contrasts() {
    std::array<std::int64_t, 3> c{};
    for (c[2] = 0; c[2] < count_[2]; ++c[2])
      for (c[1] = 0; c[1] < count_[1]; ++c[1])
        for (c[0] = 0; c[0] < count_[0]; ++c[0]) {
          FlowCell& here = cells_[index(c)];
          if (here.count == 0) continue;
          double most2 = 0;
          for (int n = 0; n < 27; ++n) {
            std::array<std::int64_t, 3> q = {c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1};
            bool inside = true;
            for (std::size_t a = 0; a < 3; ++a) {
              if (periodic_[a]) q[a] = (q[a] + count_[a]) % count_[a];
              inside = inside && q[a] >= 0 && q[a] < count_[a];
            }
            if (!inside) continue;
            const FlowCell& there = cells_[index(q)];
            if (there.count == 0) continue;
            const Trio d = there.mean - here.mean;
            most2 = std::max(most2, dot(d, d));
          }
          here.contrast = std::sqrt(most2);
        }
  }
  std::size_t index(const std::array<std::int64_t, 3>& c) const { return static_cast<std::size_t>((c[2] * count_[1] + c[1]) * count_[0] + c[0]); }

  std::array<bool, 3> periodic_{};
  std::array<double, 3> origin_{}, edge_{};
  std::array<std::int64_t, 3> count_{};
  std::vector<FlowCell> cells_;
  std::vector<std::int32_t> cell_of_;
};

void check_periodic(const PeriodicBox& box, double r_max) {
  for (std::size_t a = 0; a < 3; ++a)
    if (box.length[a] > 0 && box.length[a] < 4.2 * r_max)
      throw UsageError("box: the periodic length along " + std::string(1, "xyz"[a]) + " is " + std::to_string(box.length[a] * 1e3) +
                       " mm; it must be at least 2.1 diameters of the largest grain = " + std::to_string(4.2 * r_max * 1e3) +
                       " mm, or a grain would touch two images of another (widen the slice or lower the coarse graining)");
}

/// Allowances, drifts and life are cut together until every reach fits the periodic box.
void fit_periodic(ReachPlan& plan, const ReachInput& in, double r_max) {
  double shortest = std::numeric_limits<double>::infinity(), most = 0;
  for (const double length : in.box.length)
    if (length > 0) shortest = std::min(shortest, length);
  for (std::size_t k = 0; k < plan.reach.size(); ++k) most = std::max(most, plan.reach[k] - in.spheres[k].r);
  const double room = kMostPeriodic * shortest - r_max;
  if (!(most > room)) return;
  const double part = room / most;
  for (std::size_t k = 0; k < plan.reach.size(); ++k) {
    plan.reach[k] = in.spheres[k].r + part * (plan.reach[k] - in.spheres[k].r);
    plan.anchor[k].allowance *= static_cast<float>(part);
  }
  plan.life_s *= part;
}
}  // namespace

void ReachExperience::list_ended(bool strayed_early) {
  spread = std::clamp(spread * (strayed_early ? 1.1 : 0.985), 1.5, 12.0);
  eager = std::clamp(eager * (strayed_early ? 0.9 : 1.05), 0.15, 1.5);
}

ReachPlan plan_reach(const ReachInput& in) {
  const std::size_t n = in.spheres.size();
  ReachPlan plan;
  plan.anchor.resize(n);
  plan.reach.resize(n);
  double r_sum = 0, r_max = 0;
  Trio mean;
  for (std::size_t k = 0; k < n; ++k) r_sum += in.spheres[k].r, r_max = std::max(r_max, in.spheres[k].r), mean = mean + in.velocity[k];
  plan.life_s = std::numeric_limits<double>::infinity();
  if (n == 0) return plan;
  check_periodic(in.box, r_max);
  const double r_mean = r_sum / static_cast<double>(n);
  if (in.fixed_skin_m > 0) {
    for (std::size_t k = 0; k < n; ++k) {
      const Sphere& s = in.spheres[k];
      plan.anchor[k] = {s.x, s.y, s.z, static_cast<float>(0.5 * in.fixed_skin_m), 0, 0, 0};
      plan.reach[k] = s.r + 0.5 * in.fixed_skin_m;
    }
    fit_periodic(plan, in, r_max);
    for (const Anchor& a : plan.anchor) plan.farthest_m = std::max(plan.farthest_m, static_cast<double>(a.allowance));
    return plan;
  }

  mean = (1.0 / static_cast<double>(n)) * mean;
  double edge = kCellDiameters * 2 * r_mean, life = 0;
  for (int attempt = 0;; ++attempt) {
    const FlowGrid flow(in, edge);
    if (attempt == 0) {
      double fluctuation = 0;
      for (std::size_t k = 0; k < n; ++k) fluctuation += flow.at(k).rms + kShear * flow.at(k).contrast;
      fluctuation /= static_cast<double>(n);
      life = kAim * r_mean / (in.experience.spread * fluctuation + 1e-300) * in.experience.eager;
      life = std::min(life, std::sqrt(2 * kMostFall * r_mean / (in.gravity_m_s2 + 1e-300)));
      life = std::clamp(life, kShortest * in.time_step_s, kLongest * in.time_step_s);
    }
    const double fall = 0.5 * in.gravity_m_s2 * life * life;
    double farthest = 0, beyond = 0;
    const std::int64_t grains = static_cast<std::int64_t>(n);
#pragma omp parallel for schedule(static) reduction(max : farthest, beyond) num_threads(in.threads) if (in.threads > 1)
    for (std::int64_t i = 0; i < grains; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      const FlowCell& cell = flow.at(k);
      const Sphere& s = in.spheres[k];
      const Trio own = in.velocity[k] - cell.mean;
      const double speed = length(own);
      const bool flies = speed > kFast * cell.rms || cell.count < 4;
      const Trio u = flies ? in.velocity[k] : cell.mean;
      const double allowance = kLeast * s.r + fall + in.experience.spread * life * (cell.rms + kShear * cell.contrast);
      Anchor& a = plan.anchor[k];
      a = {s.x, s.y, s.z, static_cast<float>(allowance), static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
      plan.reach[k] = s.r + 1.000001 * (allowance + life * ((flies ? speed : 0.0) + 0.5 * cell.contrast));  // 1e-6: single precision of the anchor
      farthest = std::max(farthest, allowance + life * length(u));
      beyond = std::max(beyond, s.r + allowance + life * length(u - mean));
    }
    plan.life_s = life;
    plan.farthest_m = 1.000001 * farthest;
    if (!(beyond < 1e3)) break;  // a grain blew up: run_case() reports it
    if (flow.far_enough(1.000001 * beyond)) break;
    if (attempt < 2)
      edge = 2.1 * beyond;
    else
      life *= 0.5;
  }
  fit_periodic(plan, in, r_max);
  return plan;
}
}  // namespace venato::dem
