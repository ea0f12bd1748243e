#pragma once
/// Start states as data files that LAMMPS (atom_style sphere) and LIGGGHTS (atom_style granular) read too, so that all codes start from the same
/// text.
#include <filesystem>
#include <vector>

#include "base/vec3.h"

namespace venato::bench {

struct StartGrain {
  Vec3 position_m, velocity_m_s, spin_rad_s;
  double diameter_m;
};
struct StartState {
  double length_x_m = 0, length_y_m = 0;  ///< periodic; the box is [0, length)
  std::vector<StartGrain> grains;
};

/// 15 digits: enough that the tiles of a bed differ only by their rounding. \throws WorkError when the file cannot be written.
void write_start(const std::filesystem::path& file, const StartState& state, double density_kg_m3);
/// \throws UsageError naming the file when it is missing, cut short or not of this form.
StartState read_start(const std::filesystem::path& file);

/// nx x ny copies side by side, with the shear profile v_x += speed (1 - z/H), H = 99.5 % quantile of z; not below 0.
StartState tile_and_shear(const StartState& tile, int nx, int ny, double speed_m_s);
}  // namespace venato::bench
