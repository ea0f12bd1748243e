#pragma once
#include <vector>
#include "dem/fields/window_fields.h"
#include "line/projection/sde.h"
namespace venato::line {

/// Window fields as a field of the SDE: bilinear between cell centres, gradients are those of the interpolant (so drift and noise belong to the same
/// D and phi, and well-mixedness holds to the order of the step, not of the cell). Cells without samples or with fraction 0 are outside; values are
/// continued one or two cells into them so that the interpolant exists up to every wall. Tensors are clipped to positive semi-definite.
class GridField {
 public:
  explicit GridField(const dem::WindowFields& fields);

  struct Sample : FlowSample {
    double phi = 0;
    double gradient_of_d = 0;  ///< |grad (d_yy + d_zz) / 2| [m/s]
  };
  Sample sample(double y_m, double z_m) const;
  void velocity(double y_m, double z_m, double& u_y, double& u_z) const;

  double cell_m() const { return grid_.cell_m; }
  int column_of(double y_m) const { return static_cast<int>(std::floor((y_m - grid_.y0_m) / grid_.cell_m)); }
  int row_of(double z_m) const { return static_cast<int>(std::floor((z_m - grid_.z0_m) / grid_.cell_m)); }
  bool inside(int i, int j) const { return i >= 0 && j >= 0 && i < grid_.ny && j < grid_.nz && known_[grid_.index(i, j)]; }
  double left_edge_m(int i) const { return grid_.y0_m + i * grid_.cell_m; }
  double lower_edge_m(int j) const { return grid_.z0_m + j * grid_.cell_m; }

 private:
  struct Node {
    double phi = 0, u_y = 0, u_z = 0, d_yy = 0, d_zz = 0, d_yz = 0, d_xx = 0;
  };
  struct Stencil {
    const Node *n00, *n10, *n01, *n11;
    double f, g;  // fractions along y and z
  };
  Stencil stencil(double y_m, double z_m) const;
  void continue_outwards(std::vector<char> filled);

  dem::FieldGrid grid_;
  std::vector<char> known_;
  int width_ = 0;  // nodes per row with a border of kBorder cells on each side
  std::vector<Node> nodes_;
};
/// Which cells of the fields a tracer may be in.
bool is_known(const dem::WindowFields& fields, std::size_t cell);
}  // namespace venato::line
