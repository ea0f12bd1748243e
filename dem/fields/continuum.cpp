#include "dem/fields/continuum.h"

#include <Eigen/Dense>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "base/error.h"
#include "dem/fields/contact_line.h"
#include "dem/fields/continuum_weights.h"

namespace venato::dem {
namespace {
constexpr std::array<std::array<std::size_t, 2>, 6> kPair{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

template <std::size_t N>
void add_symmetric(std::array<double, N>& out, double w, const Vec3& a) {
  for (std::size_t k = 0; k < 6; ++k) out[k] += w * a[static_cast<int>(kPair[k][0])] * a[static_cast<int>(kPair[k][1])];
}
void add_product(std::array<double, 9>& out, double w, const Vec3& a, const Vec3& b) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(3 * r + c)] += w * a[r] * b[c];
}
void add_vector(std::array<double, 3>& out, double w, const Vec3& a) {
  for (int k = 0; k < 3; ++k) out[static_cast<std::size_t>(k)] += w * a[k];
}
Vec3 vector_of(const std::array<double, 3>& v, double scale) { return scale * Vec3(v[0], v[1], v[2]); }
Eigen::Matrix3d symmetric(const std::array<double, 6>& v, double scale) {
  Eigen::Matrix3d m;
  for (std::size_t k = 0; k < 6; ++k) {
    const int a = static_cast<int>(kPair[k][0]), b = static_cast<int>(kPair[k][1]);
    m(a, b) = m(b, a) = scale * v[k];
  }
  return m;
}
Eigen::Matrix3d matrix_of(const std::array<double, 9>& v, double scale) {
  Eigen::Matrix3d m;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m(r, c) = scale * v[static_cast<std::size_t>(3 * r + c)];
  return m;
}
std::array<double, 9> rows_of(const Eigen::Matrix3d& m) { return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)}; }

// Spreads below this part of w^2 are one grain, or grains in one plane: no gradient can be told along them.
constexpr double kNoSpread = 1e-8;

/// Pseudo-inverse of the scatter of positions.
Eigen::Matrix3d inverse_where_spread(const Eigen::Matrix3d& scatter, double width_m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const double spread = solver.eigenvalues()[k];
    if (spread > kNoSpread * width_m * width_m) inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / spread;
  }
  return inverse;
}
}  // namespace

void ContinuumSums::add(std::span<const GrainState> grains, std::span<const ContactState> contacts) {
  CellWeights weights(grid_);
  std::unordered_map<GrainId, std::size_t> at;
  at.reserve(grains.size());
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const GrainState& g = grains[k];
    at.emplace(g.id, k);
    if (g.frozen) continue;
    weights.point(g.position_m);
    outside_ += g.mass_kg * weights.for_each(g.position_m, [&](std::size_t c, double w, const Vec3& r) {
      CellSums& s = cell_[c];
      const double m = w * g.mass_kg;
      s.mass += m;
      s.mass2 += m * m;
      s.volume += w * 4.0 / 3 * std::numbers::pi * g.radius_m * g.radius_m * g.radius_m;
      add_vector(s.mv, m, g.velocity_m_s), add_symmetric(s.mvv, m, g.velocity_m_s);
      add_vector(s.mr, m, r), add_symmetric(s.mrr, m, r), add_product(s.mvr, m, g.velocity_m_s, r);
    });
  }
  for (const ContactState& c : contacts) {
    const ContactLine line = contact_line(c, grains[at.at(c.i)], c.j >= 0 ? &grains[at.at(c.j)] : nullptr);
    if (line.none) continue;
    weights.line(line.from, line.to);
    weights.for_each(line.from, [&](std::size_t k, double w, const Vec3&) { add_product(cell_[k].virial, w, line.force_n, line.from - line.to); });
    if (!line.wall) continue;
    weights.point(line.to);
    weights.for_each(line.to, [&](std::size_t k, double w, const Vec3&) { add_vector(cell_[k].wall, w, line.force_n); });
  }
  ++frames_;
}

double ContinuumFields::pressure_pa(std::size_t c) const {
  const auto &k = kinetic_stress_pa[c], &s = contact_stress_pa[c];
  return -(k[0] + k[4] + k[8] + s[0] + s[4] + s[8]) / 3;
}

ContinuumFields continuum_fields(const ContinuumSums& sums) {
  if (sums.frames() < 1) throw UsageError("continuum fields: no frame was sampled");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ContinuumFields f;
  f.grid = sums.grid(), f.frames = sums.frames();
  const double scale = 1 / (f.grid.cell_volume_m3() * static_cast<double>(f.frames));
  for (const CellSums& s : sums.cells()) {
    f.density_kg_m3.push_back(scale * s.mass);
    f.solid_fraction.push_back(scale * s.volume);
    f.momentum_kg_m2_s.push_back(vector_of(s.mv, scale));
    f.contact_stress_pa.push_back(rows_of(matrix_of(s.virial, -scale)));
    f.wall_force_n_m3.push_back(vector_of(s.wall, scale));
    f.grains.push_back(s.mass2 > 0 ? s.mass * s.mass / s.mass2 : 0);
    if (!(s.mass > 0)) {
      f.velocity_m_s.push_back(Vec3::Constant(nan));
      f.gradient_1_s.emplace_back().fill(nan);
      f.temperature_m2_s2.push_back(nan);
      f.kinetic_stress_pa.emplace_back().fill(0);
      continue;
    }
    const Vec3 v = vector_of(s.mv, 1 / s.mass), r = vector_of(s.mr, 1 / s.mass);
    const Eigen::Matrix3d vv = symmetric(s.mvv, 1 / s.mass) - v * v.transpose();
    const Eigen::Matrix3d vr = matrix_of(s.mvr, 1 / s.mass) - v * r.transpose();
    const Eigen::Matrix3d rr = symmetric(s.mrr, 1 / s.mass) - r * r.transpose();
    const Eigen::Matrix3d gradient = vr * inverse_where_spread(rr, f.grid.width_m);
    f.velocity_m_s.push_back(v);
    f.gradient_1_s.push_back(rows_of(gradient));
    f.temperature_m2_s2.push_back(std::max(0.0, (vv - gradient * vr.transpose()).trace()) / 3);
    f.kinetic_stress_pa.push_back(rows_of(-scale * s.mass * vv));
  }
  return f;
}
}  // namespace venato::dem
