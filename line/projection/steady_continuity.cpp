#include "line/projection/steady_continuity.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "line/projection/flux_profile.h"

namespace venato::line {
namespace {
constexpr int kWall = -1;

struct Neighbour {
  int di, dj;
};
constexpr std::array<Neighbour, 4> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

class Region {
 public:
  Region(const dem::WindowFields& fields, const FluxProfile& inlet, const FluxProfile& outlet)
      : fields_(fields), g_(fields.grid), inlet_(inlet), outlet_(outlet), number_(g_.size(), kWall) {
    flood();
  }
  const std::vector<std::size_t>& cells() const { return cells_; }
  int number(std::size_t cell) const { return number_[cell]; }
  int column(std::size_t c) const { return static_cast<int>(c % static_cast<std::size_t>(g_.ny)); }
  int row(std::size_t c) const { return static_cast<int>(c / static_cast<std::size_t>(g_.ny)); }
  double phi_u(std::size_t c, Neighbour n) const {
    return fields_.solid_fraction[c] * (n.di * fields_.velocity_y_m_s[c] + n.dj * fields_.velocity_z_m_s[c]);
  }

  enum class Face { inner, wall, inlet, outlet };
  Face face(std::size_t c, Neighbour n, std::size_t& other) const {
    const int i = column(c), j = row(c), i2 = i + n.di, j2 = j + n.dj;
    if (separates(inlet_, i, j, n)) return Face::inlet;
    if (separates(outlet_, i, j, n)) return Face::outlet;
    if (i2 < 0 || j2 < 0 || i2 >= g_.ny || j2 >= g_.nz) return Face::wall;
    other = g_.index(i2, j2);
    return is_known(fields_, other) ? Face::inner : Face::wall;
  }

 private:
  // The line between two cell centres crosses the segment.
  bool separates(const FluxProfile& p, int i, int j, Neighbour n) const {
    const double y = g_.y0_m + (i + 0.5) * g_.cell_m, z = g_.z0_m + (j + 0.5) * g_.cell_m;
    const double a = p.ahead_m(y, z), b = p.ahead_m(y + n.di * g_.cell_m, z + n.dj * g_.cell_m);
    if ((a >= 0) == (b >= 0)) return false;
    const double t = a / (a - b), s = p.along_m(y + t * n.di * g_.cell_m, z + t * n.dj * g_.cell_m);
    return s >= 0 && s <= p.length_m;
  }
  void flood() {
    std::vector<std::size_t> open;
    const auto visit = [&](std::size_t c) {
      if (number_[c] != kWall) return;
      number_[c] = 0;
      open.push_back(c);
    };
    for (std::size_t c = 0; c < number_.size(); ++c)
      for (const Neighbour n : kNeighbours) {
        const double y = g_.y0_m + (column(c) + 0.5) * g_.cell_m, z = g_.z0_m + (row(c) + 0.5) * g_.cell_m;
        if (is_known(fields_, c) && separates(inlet_, column(c), row(c), n) && inlet_.ahead_m(y, z) >= 0) visit(c);
      }
    while (!open.empty()) {
      const std::size_t c = open.back();
      open.pop_back();
      for (const Neighbour n : kNeighbours) {
        std::size_t other = 0;
        if (face(c, n, other) == Face::inner) visit(other);
      }
    }
    for (std::size_t c = 0; c < number_.size(); ++c)
      if (number_[c] != kWall) {
        number_[c] = static_cast<int>(cells_.size());
        cells_.push_back(c);
      }
  }

  const dem::WindowFields& fields_;
  const dem::FieldGrid& g_;
  const FluxProfile &inlet_, &outlet_;
  std::vector<int> number_;
  std::vector<std::size_t> cells_;
};
}  // namespace

ContinuityReport enforce_steady_continuity(dem::WindowFields& fields, const Segment& inlet_segment, const Segment& outlet_segment) {
  const GridField field(fields);
  const FluxProfile inlet = flux_profile(field, inlet_segment, SegmentRole::inlet), outlet = flux_profile(field, outlet_segment, SegmentRole::outlet);
  const Region region(fields, inlet, outlet);
  const auto n = static_cast<Eigen::Index>(region.cells().size());
  const double h = fields.grid.cell_m;

  double in = 0, out = 0;
  for (std::size_t c : region.cells())
    for (const Neighbour d : kNeighbours) {
      std::size_t other = 0;
      const auto kind = region.face(c, d, other);
      if (kind == Region::Face::inlet) in -= region.phi_u(c, d);
      if (kind == Region::Face::outlet) out += region.phi_u(c, d);
    }
  if (!(in > 0) || !(out > 0))
    throw WorkError("steady continuity: " + std::to_string(in * h) + " m2/s enter the region behind the inlet and " + std::to_string(out * h) +
                    " m2/s leave it through the outlet; both must be positive (is there powder all the way in the measured window?)");
  ContinuityReport report;
  report.outlet_scale = in / out;

  // Net outflow of each cell from face fluxes, and the matrix of div(phi grad); times h throughout, so that fluxes are phi u.
  Eigen::VectorXd net = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t c = region.cells()[static_cast<std::size_t>(k)];
    double diagonal = 0;
    for (const Neighbour d : kNeighbours) {
      std::size_t other = 0;
      switch (region.face(c, d, other)) {
        case Region::Face::wall:
          break;
        case Region::Face::inlet:
          net[k] += region.phi_u(c, d);
          break;
        case Region::Face::outlet:
          net[k] += report.outlet_scale * region.phi_u(c, d);
          break;
        case Region::Face::inner: {
          net[k] += 0.5 * (region.phi_u(c, d) + region.phi_u(other, d));
          const double phi = 0.5 * (fields.solid_fraction[c] + fields.solid_fraction[other]);
          diagonal += phi;
          entries.emplace_back(k, region.number(other), -phi);
        }
      }
    }
    entries.emplace_back(k, k, diagonal);
  }
  // psi is free up to a constant: tie one cell, weakly, which does not disturb the balanced right-hand side.
  entries.emplace_back(0, 0, 1.0);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd psi = solver.solve(-net);
  if (solver.info() != Eigen::Success || !psi.allFinite()) throw WorkError("steady continuity: the pressure equation could not be solved");

  const double total = std::sqrt(static_cast<double>(n));
  report.defect_before = net.norm() / total / in;
  Eigen::VectorXd after = net;
  double change = 0, before = 0;
  std::vector<double> du_y(static_cast<std::size_t>(n)), du_z(static_cast<std::size_t>(n));
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t c = region.cells()[static_cast<std::size_t>(k)];
    double sum_y = 0, sum_z = 0;
    for (const Neighbour d : kNeighbours) {
      std::size_t other = 0;
      if (region.face(c, d, other) != Region::Face::inner) continue;
      const double phi = 0.5 * (fields.solid_fraction[c] + fields.solid_fraction[other]);
      const double flux = -phi * (psi[region.number(other)] - psi[k]);
      after[k] += flux;
      sum_y += 0.5 * d.di * flux;
      sum_z += 0.5 * d.dj * flux;
    }
    du_y[static_cast<std::size_t>(k)] = sum_y / fields.solid_fraction[c];
    du_z[static_cast<std::size_t>(k)] = sum_z / fields.solid_fraction[c];
  }
  for (std::size_t k = 0; k < region.cells().size(); ++k) {
    const std::size_t c = region.cells()[k];
    before += fields.velocity_y_m_s[c] * fields.velocity_y_m_s[c] + fields.velocity_z_m_s[c] * fields.velocity_z_m_s[c];
    change += du_y[k] * du_y[k] + du_z[k] * du_z[k];
    fields.velocity_y_m_s[c] += du_y[k];
    fields.velocity_z_m_s[c] += du_z[k];
  }
  report.defect_after = after.norm() / total / in;
  report.velocity_change = std::sqrt(change / before);
  return report;
}
}  // namespace venato::line
