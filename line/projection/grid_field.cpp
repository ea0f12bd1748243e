#include "line/projection/grid_field.h"

#include "base/expects.h"

namespace venato::line {
namespace {
constexpr int kBorder = 2;  // midpoints reach at most a step (half a cell and some noise) beyond a wall
}

bool is_known(const dem::WindowFields& fields, std::size_t cell) { return fields.solid_fraction[cell] > 0; }

GridField::GridField(const dem::WindowFields& fields) : grid_(fields.grid) {
  const std::size_t size = grid_.size();
  VENATO_EXPECTS(size > 0 && grid_.cell_m > 0);
  for (const auto* v : {&fields.solid_fraction, &fields.velocity_y_m_s, &fields.velocity_z_m_s, &fields.d_xx_m2_s, &fields.d_yy_m2_s,
                        &fields.d_zz_m2_s, &fields.d_yz_m2_s})
    VENATO_EXPECTS(v->size() == size);
  known_.assign(size, 0);
  width_ = grid_.ny + 2 * kBorder;
  nodes_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(grid_.nz + 2 * kBorder));
  std::vector<char> filled(nodes_.size(), 0);
  for (int j = 0; j < grid_.nz; ++j)
    for (int i = 0; i < grid_.ny; ++i) {
      const std::size_t c = grid_.index(i, j), n = static_cast<std::size_t>((j + kBorder) * width_ + i + kBorder);
      if (!is_known(fields, c)) continue;
      known_[c] = filled[n] = 1;
      const double d_yy = std::max(0.0, fields.d_yy_m2_s[c]), d_zz = std::max(0.0, fields.d_zz_m2_s[c]);
      const double limit = std::sqrt(d_yy * d_zz);
      nodes_[n] = {fields.solid_fraction[c],
                   fields.velocity_y_m_s[c],
                   fields.velocity_z_m_s[c],
                   d_yy,
                   d_zz,
                   std::clamp(fields.d_yz_m2_s[c], -limit, limit),
                   std::max(0.0, fields.d_xx_m2_s[c])};
    }
  continue_outwards(std::move(filled));
}

// Mean of the known neighbours, nearest ring first: a zero gradient through the wall, as reflection there asks for.
void GridField::continue_outwards(std::vector<char> filled) {
  const int height = grid_.nz + 2 * kBorder;
  for (int ring = 0; ring < kBorder; ++ring) {
    const std::vector<char> before = filled;
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width_; ++i) {
        const auto at = static_cast<std::size_t>(j * width_ + i);
        if (before[at]) continue;
        for (const bool diagonal : {false, true}) {
          int count = 0;
          Node sum;
          for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di) {
              if ((di != 0 && dj != 0) != diagonal || i + di < 0 || j + dj < 0 || i + di >= width_ || j + dj >= height) continue;
              const auto from = static_cast<std::size_t>((j + dj) * width_ + i + di);
              if (!before[from]) continue;
              const Node& n = nodes_[from];
              sum = {sum.phi + n.phi, sum.u_y + n.u_y, sum.u_z + n.u_z, sum.d_yy + n.d_yy, sum.d_zz + n.d_zz, sum.d_yz + n.d_yz, sum.d_xx + n.d_xx};
              ++count;
            }
          if (count == 0) continue;
          const double s = 1.0 / count;
          nodes_[at] = {s * sum.phi, s * sum.u_y, s * sum.u_z, s * sum.d_yy, s * sum.d_zz, s * sum.d_yz, s * sum.d_xx};
          filled[at] = 1;
          break;
        }
      }
  }
}

GridField::Stencil GridField::stencil(double y_m, double z_m) const {
  const double a = std::clamp((y_m - grid_.y0_m) / grid_.cell_m + kBorder - 0.5, 0.0, width_ - 1.0);
  const double b = std::clamp((z_m - grid_.z0_m) / grid_.cell_m + kBorder - 0.5, 0.0, grid_.nz + 2.0 * kBorder - 1.0);
  const int i = std::min(static_cast<int>(a), width_ - 2), j = std::min(static_cast<int>(b), grid_.nz + 2 * kBorder - 2);
  const Node* n = nodes_.data() + static_cast<std::size_t>(j * width_ + i);
  return {n, n + 1, n + width_, n + width_ + 1, a - i, b - j};
}

void GridField::velocity(double y_m, double z_m, double& u_y, double& u_z) const {
  const Stencil s = stencil(y_m, z_m);
  const double w00 = (1 - s.f) * (1 - s.g), w10 = s.f * (1 - s.g), w01 = (1 - s.f) * s.g, w11 = s.f * s.g;
  u_y = w00 * s.n00->u_y + w10 * s.n10->u_y + w01 * s.n01->u_y + w11 * s.n11->u_y;
  u_z = w00 * s.n00->u_z + w10 * s.n10->u_z + w01 * s.n01->u_z + w11 * s.n11->u_z;
}

GridField::Sample GridField::sample(double y_m, double z_m) const {
  const Stencil s = stencil(y_m, z_m);
  const double w00 = (1 - s.f) * (1 - s.g), w10 = s.f * (1 - s.g), w01 = (1 - s.f) * s.g, w11 = s.f * s.g;
  const auto value = [&](double Node::*m) { return w00 * s.n00->*m + w10 * s.n10->*m + w01 * s.n01->*m + w11 * s.n11->*m; };
  const auto along_y = [&](double Node::*m) { return ((s.n10->*m - s.n00->*m) * (1 - s.g) + (s.n11->*m - s.n01->*m) * s.g) / grid_.cell_m; };
  const auto along_z = [&](double Node::*m) { return ((s.n01->*m - s.n00->*m) * (1 - s.f) + (s.n11->*m - s.n10->*m) * s.f) / grid_.cell_m; };
  Sample out;
  out.phi = value(&Node::phi);
  out.u_y = value(&Node::u_y);
  out.u_z = value(&Node::u_z);
  out.d_yy = value(&Node::d_yy);
  out.d_zz = value(&Node::d_zz);
  out.d_yz = value(&Node::d_yz);
  out.d_xx = value(&Node::d_xx);
  const double dyy_y = along_y(&Node::d_yy), dyy_z = along_z(&Node::d_yy), dzz_y = along_y(&Node::d_zz), dzz_z = along_z(&Node::d_zz);
  const double lnphi_y = along_y(&Node::phi) / out.phi, lnphi_z = along_z(&Node::phi) / out.phi;
  out.drift_y = dyy_y + along_z(&Node::d_yz) + out.d_yy * lnphi_y + out.d_yz * lnphi_z;
  out.drift_z = dzz_z + along_y(&Node::d_yz) + out.d_zz * lnphi_z + out.d_yz * lnphi_y;
  out.gradient_of_d = 0.5 * std::hypot(dyy_y + dzz_y, dyy_z + dzz_z);
  return out;
}
}  // namespace venato::line
