#include "dem/packing/soft_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace venato::dem {
namespace {
constexpr std::int64_t kBlock = 1024;  // spheres per partial sum: fixed, so that sums do not depend on threads
constexpr double kMostMove = 0.1;      // of a radius per coordinate and step
// Skin in mean radii, steered by how long lists live: thick while a random start is torn apart, thin near the end.
constexpr double kFirst = 0.3, kThinnest = 0.05, kThickest = 0.6;
constexpr std::int64_t kShortLife = 8, kLongLife = 40;

double& coordinate(Sphere& s, int axis) { return axis == 0 ? s.x : (axis == 1 ? s.y : s.z); }
}  // namespace

SoftSpheres::SoftSpheres(const Box& box, std::span<const Vec3> positions, std::span<const double> radii, double swelling, int threads)
    : box_(box), periodic_(PeriodicBox::from(box)), threads_(threads), swelling_(swelling) {
  for (std::size_t a = 0; a < 3; ++a) {
    length_[a] = periodic_.length[a];
    half_[a] = length_[a] > 0 ? 0.5 * length_[a] : std::numeric_limits<double>::infinity();
  }
  sphere_.reserve(positions.size());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    sphere_.push_back({positions[k].x(), positions[k].y(), positions[k].z(), radii[k]});
    mean_radius_ += radii[k];
    for (int a = 0; a < 3; ++a)
      if (!periodic_.periodic(a)) {
        double& x = coordinate(sphere_.back(), a);
        x = std::clamp(x, std::min(box.low[a] + radii[k], box.high[a] - radii[k]), std::max(box.low[a] + radii[k], box.high[a] - radii[k]));
      }
  }
  mean_radius_ /= static_cast<double>(std::max<std::size_t>(1, positions.size()));
  wanted_skin_ = kFirst * mean_radius_;
  velocity_.assign(size(), {});
  force_.assign(size(), {});
  original_.resize(size());
  std::iota(original_.begin(), original_.end(), 0);
}

void SoftSpheres::wrap(Sphere& s) const {
  for (int a = 0; a < 3; ++a) {
    const std::size_t k = static_cast<std::size_t>(a);
    if (!(length_[k] > 0)) continue;
    double& x = coordinate(s, a);
    x -= length_[k] * std::floor((x - periodic_.low[k]) / length_[k]);
  }
}

bool SoftSpheres::list_is_stale() const {
  if (sphere_at_build_.size() != sphere_.size()) return true;
  const double limit2 = 0.25 * skin_ * skin_;
  const std::int64_t n = static_cast<std::int64_t>(size());
  bool stale = false;
#pragma omp parallel for schedule(static) num_threads(threads_) reduction(|| : stale)
  for (std::int64_t i = 0; i < n; ++i) {
    const Sphere &a = sphere_[static_cast<std::size_t>(i)], &b = sphere_at_build_[static_cast<std::size_t>(i)];
    const double dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    stale = stale || !(dx * dx + dy * dy + dz * dz <= limit2);
  }
  return stale;
}

void SoftSpheres::steer_skin() {
  if (evaluation_of_build_ >= 0) {
    const std::int64_t life = evaluations_ - evaluation_of_build_;
    if (life < kShortLife) wanted_skin_ *= 1.2;
    if (life > kLongLife) wanted_skin_ /= 1.3;
  }
  wanted_skin_ = std::clamp(wanted_skin_, kThinnest * mean_radius_, kThickest * mean_radius_);
  evaluation_of_build_ = evaluations_;
}

void SoftSpheres::rebuild_list(double skin) {
  skin_ = skin;
  const std::int64_t n = static_cast<std::int64_t>(size());
  for (Sphere& s : sphere_) wrap(s);
  const double grown = 1 + swelling_;
  std::vector<Sphere> grown_spheres(sphere_.begin(), sphere_.end());
  for (Sphere& s : grown_spheres) s.r = grown * s.r + 0.5 * skin_;
  const std::vector<std::int32_t> order = grid_.build(grown_spheres, periodic_, threads_);
  const auto in_order = [&](auto& values) {
    auto sorted = values;
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::int64_t k = 0; k < n; ++k) sorted[static_cast<std::size_t>(k)] = values[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])];
    values.swap(sorted);
  };
  in_order(sphere_), in_order(velocity_), in_order(original_);

  const std::int64_t blocks = (n + kBlock - 1) / kBlock;
  std::vector<std::vector<std::int32_t>> found(static_cast<std::size_t>(blocks));
  first_.assign(static_cast<std::size_t>(n) + 1, 0);
#pragma omp parallel for schedule(dynamic, 4) num_threads(threads_)
  for (std::int64_t b = 0; b < blocks; ++b) {
    std::vector<std::int32_t>& out = found[static_cast<std::size_t>(b)];
    for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
      const Sphere p = sphere_[static_cast<std::size_t>(i)];
      const std::size_t before = out.size();
      const double own = grown * p.r + skin_;
      grid_.for_runs_near(p.x, p.y, p.z, grown * p.r + 0.5 * skin_, [&](std::int32_t from, std::int32_t to) {
        for (std::int32_t j = from; j < to; ++j) {
          const Sphere& q = sphere_[static_cast<std::size_t>(j)];
          double dx = std::abs(q.x - p.x), dy = std::abs(q.y - p.y), dz = std::abs(q.z - p.z);
          dx = dx > half_[0] ? length_[0] - dx : dx, dy = dy > half_[1] ? length_[1] - dy : dy, dz = dz > half_[2] ? length_[2] - dz : dz;
          const double reach = own + grown * q.r;
          if (dx * dx + dy * dy + dz * dz < reach * reach && j != i) out.push_back(j);
        }
      });
      first_[static_cast<std::size_t>(i) + 1] = static_cast<std::int64_t>(out.size() - before);
    }
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) first_[i + 1] += first_[i];
  neighbour_.resize(static_cast<std::size_t>(first_.back()));
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (std::int64_t b = 0; b < blocks; ++b)
    std::copy(found[static_cast<std::size_t>(b)].begin(), found[static_cast<std::size_t>(b)].end(),
              neighbour_.begin() + first_[static_cast<std::size_t>(b * kBlock)]);
  sphere_at_build_ = sphere_;
}

SoftSpheres::Sums SoftSpheres::evaluate() {
  if (list_is_stale()) {
    steer_skin();
    rebuild_list(wanted_skin_);
  }
  ++evaluations_;
  const std::int64_t n = static_cast<std::int64_t>(size()), blocks = (n + kBlock - 1) / kBlock;
  std::vector<Sums> part(static_cast<std::size_t>(blocks));
  const double grown = 1 + swelling_, inf = std::numeric_limits<double>::infinity();
  double face_low[3], face_high[3];
  for (int a = 0; a < 3; ++a) face_low[a] = periodic_.periodic(a) ? -inf : box_.low[a], face_high[a] = periodic_.periodic(a) ? inf : box_.high[a];
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (std::int64_t b = 0; b < blocks; ++b) {
    Sums s;
    for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
      const Sphere p = sphere_[static_cast<std::size_t>(i)];
      const double grown_r = grown * p.r;
      double f[3] = {0, 0, 0};
      for (std::int64_t k = first_[static_cast<std::size_t>(i)]; k < first_[static_cast<std::size_t>(i) + 1]; ++k) {
        const Sphere& q = sphere_[static_cast<std::size_t>(neighbour_[static_cast<std::size_t>(k)])];
        double dx = p.x - q.x, dy = p.y - q.y, dz = p.z - q.z;
        dx -= dx > half_[0] ? length_[0] : (dx < -half_[0] ? -length_[0] : 0);
        dy -= dy > half_[1] ? length_[1] : (dy < -half_[1] ? -length_[1] : 0);
        dz -= dz > half_[2] ? length_[2] : (dz < -half_[2] ? -length_[2] : 0);
        const double reach = grown_r + grown * q.r, d2 = dx * dx + dy * dy + dz * dz;
        if (d2 >= reach * reach) continue;
        // Two spheres at one place (equal random numbers, or pushed together): apart along x, the lower slot towards -x.
        const double d = std::sqrt(d2), overlap = reach - d, scale = d > 0 ? overlap / d : 0;
        if (d > 0)
          f[0] += scale * dx, f[1] += scale * dy, f[2] += scale * dz;
        else
          f[0] += neighbour_[static_cast<std::size_t>(k)] > i ? -overlap : overlap;
        s.energy += 0.25 * overlap * overlap;
        s.max_overlap = std::max(s.max_overlap, (p.r + q.r - d) / std::min(p.r, q.r));
      }
      const double x[3] = {p.x, p.y, p.z};
      for (int a = 0; a < 3; ++a) {
        const double low = grown_r - (x[a] - face_low[a]), high = grown_r - (face_high[a] - x[a]);
        if (low > 0) f[a] += low, s.energy += 0.5 * low * low, s.max_overlap = std::max(s.max_overlap, low / p.r - swelling_);
        if (high > 0) f[a] -= high, s.energy += 0.5 * high * high, s.max_overlap = std::max(s.max_overlap, high / p.r - swelling_);
      }
      const std::array<double, 3>& v = velocity_[static_cast<std::size_t>(i)];
      force_[static_cast<std::size_t>(i)] = {f[0], f[1], f[2]};
      s.power += f[0] * v[0] + f[1] * v[1] + f[2] * v[2];
      s.force2 += f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
      s.velocity2 += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    }
    part[static_cast<std::size_t>(b)] = s;
  }
  Sums all;
  for (const Sums& s : part) {
    all.power += s.power, all.force2 += s.force2, all.velocity2 += s.velocity2, all.energy += s.energy;
    all.max_overlap = std::max(all.max_overlap, s.max_overlap);
  }
  return all;
}

void SoftSpheres::move(double dt, double keep, double turn) {
  const std::int64_t n = static_cast<std::int64_t>(size());
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (std::int64_t i = 0; i < n; ++i) {
    Sphere& s = sphere_[static_cast<std::size_t>(i)];
    std::array<double, 3>& v = velocity_[static_cast<std::size_t>(i)];
    const std::array<double, 3>& f = force_[static_cast<std::size_t>(i)];
    const double most = kMostMove * s.r / dt;
    for (std::size_t a = 0; a < 3; ++a) v[a] = std::clamp(keep * v[a] + (turn + dt) * f[a], -most, most);
    s.x += dt * v[0], s.y += dt * v[1], s.z += dt * v[2];
  }
}

std::vector<std::array<std::int32_t, 2>> SoftSpheres::near_pairs(double gap_fraction) {
  rebuild_list(std::max(wanted_skin_, gap_fraction * mean_radius_));
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (std::size_t i = 0; i < size(); ++i)
    for (std::int64_t k = first_[i]; k < first_[i + 1]; ++k) {
      const std::size_t j = static_cast<std::size_t>(neighbour_[static_cast<std::size_t>(k)]);
      if (j < i) continue;
      const Sphere &p = sphere_[i], &q = sphere_[j];
      double dx = std::abs(q.x - p.x), dy = std::abs(q.y - p.y), dz = std::abs(q.z - p.z);
      dx = dx > half_[0] ? length_[0] - dx : dx, dy = dy > half_[1] ? length_[1] - dy : dy, dz = dz > half_[2] ? length_[2] - dz : dz;
      const double reach = p.r + q.r + gap_fraction * std::min(p.r, q.r);
      if (dx * dx + dy * dy + dz * dz < reach * reach) pairs.push_back({original_[i], original_[j]});
    }
  return pairs;
}

std::vector<Vec3> SoftSpheres::positions_m() const {
  std::vector<Vec3> out(size());
  for (std::size_t k = 0; k < size(); ++k) {
    Sphere s = sphere_[k];
    wrap(s);
    out[static_cast<std::size_t>(original_[k])] = Vec3(s.x, s.y, s.z);
  }
  return out;
}
}  // namespace venato::dem
