#pragma once
/// What `fields` of a DEM case keeps: the continuum fields on its grid, the same means with other widths, and (if asked) the diffusivity.
#include <optional>
#include <vector>

#include "dem/fields/continuum.h"
#include "dem/fields/window_fields.h"
namespace venato::dem {

/// Fields at the mean height of the grains, averaged over x and y, against the width of the kernel. Between the grains (widths far below a diameter
/// show layers) and the bed (widths that reach its surfaces smear them) there is a plateau: a width on it may be used.
struct PlateauScan {
  double z_m = 0;
  std::vector<double> width_m, density_kg_m3, stress_zz_pa, temperature_m2_s2;
};
struct FieldResult {
  ContinuumFields fields;
  PlateauScan plateau;
  double balance_residual = 0;  ///< momentum_balance() of the last frame, largest residual over largest term: rounding (1e-12) when all is well
  std::optional<WindowFields> diffusivity;  ///< FieldPlan::diffusivity and at least 3 frames
};

class FieldRecorder {
 public:
  FieldRecorder(const Box& box, const FieldPlan& plan, const Vec3& gravity_m_s2, double coarse_graining);
  void take(const Simulation& sim);
  bool has_frames() const { return sums_.frames() > 0; }
  FieldResult finish() const;  ///< \throws UsageError without frames

  template <class Archive>
  void exchange(Archive& a) {
    exchange_parts(a, *this);
  }
  template <class Archive>
  void exchange(Archive& a) const {
    exchange_parts(a, *this);
  }

 private:
  template <class Archive, class Self>
  static void exchange_parts(Archive& a, Self& self) {
    self.sums_.exchange(a);
    for (auto& s : self.scan_) s.exchange(a);
    a.value(self.balance_residual_);
    exchange_frames(a, self.frames_);
  }
  template <class Archive, class Frames>
  static void exchange_frames(Archive& a, Frames& frames) {
    auto n = static_cast<std::uint64_t>(frames.size());
    a.value(n);
    if constexpr (!std::is_const_v<Frames>) frames.resize(n);
    for (auto& s : frames) a.value(s.time_s), a.list(s.id), a.list(s.position_m), a.list(s.velocity_m_s), a.list(s.radius_m), a.list(s.species);
  }

  Box box_;
  FieldPlan plan_;
  Vec3 gravity_;
  double coarse_graining_;
  ContinuumSums sums_;
  std::vector<ContinuumSums> scan_;  ///< one width each
  std::vector<Snapshot> frames_;     ///< for the diffusivity
  double balance_residual_ = 0;
};

/// Widths of the scan: from an eighth of the plan's width to four times it, in steps of sqrt(2).
std::vector<double> plateau_widths(double width_m);
/// All positions of a Simulation at this step, as run_case() keeps them.
Snapshot snapshot_of(const Simulation& sim);
}  // namespace venato::dem
