#pragma once
/// Frictionless soft spheres for overlap removal (dem/packing/): harmonic repulsion force = overlap between spheres and at flat faces.
/// Kept in cell order with a list of all neighbours of each sphere, so that each sphere sums its own forces in a fixed order: the bits do not depend
/// on the number of threads.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/case.h"
#include "dem/neighbours/cell_grid.h"

namespace venato::dem {

class SoftSpheres {
 public:
  /// \param positions_m inside the box (periodic axes are wrapped, others clamped so that the sphere is inside)
  /// \param radii_m the hard radii, > 0
  /// \param swelling the spheres repel as if their radii were (1 + swelling) times as large, so that hard overlaps vanish before the forces do
  SoftSpheres(const Box& box, std::span<const Vec3> positions_m, std::span<const double> radii_m, double swelling, int threads);

  struct Sums {
    double power = 0;   ///< force . velocity
    double force2 = 0;  ///< sum of squares
    double velocity2 = 0;
    double energy = 0;       ///< 1/2 overlap^2, swollen; half a pair's for each of the two
    double max_overlap = 0;  ///< hard overlap / smaller hard radius
  };
  /// Forces and sums of the present state; renews the list when spheres have moved too far.
  Sums evaluate();
  /// v = keep v + (turn + dt) F, x += dt v; no coordinate moves more than a tenth of the sphere's radius.
  void move(double dt, double keep, double turn);

  /// Pairs closer than touching (hard radii) plus gap_fraction of the smaller radius, each once, constructor's indices.
  std::vector<std::array<std::int32_t, 2>> near_pairs(double gap_fraction);
  /// In the order of the constructor's spheres, wrapped into the box.
  std::vector<Vec3> positions_m() const;
  std::size_t size() const { return sphere_.size(); }

 private:
  bool list_is_stale() const;
  void rebuild_list(double skin_m);
  void steer_skin();
  void wrap(Sphere& s) const;

  Box box_;
  PeriodicBox periodic_;
  std::array<double, 3> length_{}, half_{};  ///< half_ is infinite where not periodic
  int threads_;
  double swelling_, mean_radius_ = 0, skin_ = 0, wanted_skin_ = 0;
  std::int64_t evaluations_ = 0, evaluation_of_build_ = -1;
  std::vector<Sphere> sphere_, sphere_at_build_;  ///< r: hard radius
  std::vector<std::array<double, 3>> velocity_, force_;
  std::vector<std::int32_t> original_;  ///< index in the constructor's order
  CellGrid grid_;
  std::vector<std::int64_t> first_;  ///< [sphere + 1] into neighbour_
  std::vector<std::int32_t> neighbour_;
};
}  // namespace venato::dem
