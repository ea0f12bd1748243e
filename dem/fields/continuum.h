#pragma once
/// Continuum fields of a DEM by coarse graining (Goldhirsch 2010), with the boundary term of Weinhart, Thornton, Luding & Bokhove 2012.
///
///   rho    = sum_i m_i phi(r - r_i),   j = sum_i m_i v_i phi,   V = j / rho
///   sigma  = sigma_k + sigma_c                                                       tension positive
///   sigma_k = -sum_i m_i (v_i - V)(v_i - V) phi,   sigma_c = -sum_contacts f (r_i - r_j) int_0^1 phi(r - r_i + s (r_i - r_j)) ds,  f = force on i
///   t      = sum_wall contacts f phi(r - c)                                          force of walls on the grains per volume, c = contact point
/// With walls and frozen grains the line ends at the contact point. Mass and momentum then balance exactly, for any width and any cell:
///   d(rho)/dt + div j = 0,     d(j)/dt + div(rho V V) = div sigma + rho g + t
/// Times are averaged: rho, j, sum m v v, sigma_c and t over the frames, V and sigma_k from these means (so sigma_k holds what fluctuates in time).
/// Frozen grains are walls: they have no mass here. Fields within 3 w of a wall or a free surface see it; t tells where.
#include <array>
#include <span>
#include <vector>

#include "dem/fields/continuum_grid.h"
#include "dem/simulation/simulation.h"
namespace venato::dem {

/// Sums over grains, contacts and frames in one cell, weighted with the cells' shares.
struct CellSums {
  double mass = 0, volume = 0;     ///< [kg] [m3]
  double mass2 = 0;                ///< [kg2] of shares: how few grains carry the cell
  std::array<double, 3> mv{};      ///< [kg m/s]
  std::array<double, 6> mvv{};     ///< xx yy zz xy xz yz
  std::array<double, 3> mr{};      ///< r = from the cell's centre
  std::array<double, 6> mrr{};     ///< as mvv
  std::array<double, 9> mvr{};     ///< [row v][column r]
  std::array<double, 9> virial{};  ///< [N m] f (r_i - r_j): [row f][column branch]
  std::array<double, 3> wall{};    ///< [N]
};

class ContinuumSums {
 public:
  explicit ContinuumSums(const ContinuumGrid& grid) : grid_(grid), cell_(grid.size()) {}
  /// One instant. \param grains, contacts of the same Simulation at the same step (Simulation::grains(), ::contacts()).
  void add(std::span<const GrainState> grains, std::span<const ContactState> contacts);
  const ContinuumGrid& grid() const { return grid_; }
  const std::vector<CellSums>& cells() const { return cell_; }
  std::int64_t frames() const { return frames_; }
  double mass_outside_kg() const { return outside_; }  ///< fell off the grid; 0 while grains are inside the box of make_continuum_grid
  /// Checkpoint: into a ContinuumSums of the same grid.
  template <class Archive>
  void exchange(Archive& a) {
    a.list(cell_), a.value(frames_), a.value(outside_);
  }
  template <class Archive>
  void exchange(Archive& a) const {
    a.list(cell_), a.value(frames_), a.value(outside_);
  }

 private:
  ContinuumGrid grid_;
  std::vector<CellSums> cell_;
  std::int64_t frames_ = 0;
  double outside_ = 0;
};

/// Tensors row-major xx xy xz yx …; [row = force or velocity][column = direction of the face or of the gradient].
struct ContinuumFields {
  ContinuumGrid grid;
  std::int64_t frames = 0;
  std::vector<double> density_kg_m3, solid_fraction;
  std::vector<Vec3> momentum_kg_m2_s;               ///< per volume
  std::vector<Vec3> velocity_m_s;                   ///< NaN where there is no mass
  std::vector<std::array<double, 9>> gradient_1_s;  ///< of the velocity: best affine flow in the kernel; 0 along directions without spread
  std::vector<double> temperature_m2_s2;            ///< <v' v'> / 3, v' about the best affine flow of the kernel; NaN where there is no mass
  std::vector<std::array<double, 9>> kinetic_stress_pa, contact_stress_pa;  ///< tension positive; v' of the kinetic one is about V
  std::vector<Vec3> wall_force_n_m3;                                        ///< t
  std::vector<double> grains;                                               ///< grain-frames that carry the cell, (sum m)^2 / sum m^2
  double pressure_pa(std::size_t cell) const;                               ///< -tr(sigma) / 3
};
/// The kinetic stress takes v' about V of the cell, which includes w^2 times the squared velocity gradient (that is what makes the balance exact);
/// the temperature takes it about the best affine flow through the grains of the kernel: zero for any rigid rotation or uniform strain. A fit
/// through few grains takes away some of the fluctuation, too: read it where `grains` >> 4.
/// \throws UsageError without frames.
ContinuumFields continuum_fields(const ContinuumSums& sums);
}  // namespace venato::dem
