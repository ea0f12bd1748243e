#pragma once
/// ParaView files of a running case: <folder>/grains_000012.vtp, <folder>/walls_000012.vtp (XML PolyData, binary appended, little endian) and the
/// time series <folder>/grains.pvd, <folder>/walls.pvd. SI units. Files appear only when complete. Same data, same bytes.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>
#include "dem/case.h"

namespace venato::dem {

/// One frame of grains; all spans have the same length (order as given; sort by id for reproducible files).
struct VtkGrains {
  std::span<const Vec3> position_m;       ///< [m]
  std::span<const Vec3> velocity_m_s;     ///< [m/s]
  std::span<const double> radius_m;       ///< [m]
  std::span<const std::int32_t> species;  ///< powder index
  std::span<const std::int64_t> id;
};

/// The triangles of all walls present, where they are at this time; `wall[k]` is the index in Case::walls of triangle k.
struct VtkWalls {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> wall;
};

/// Triangles that show a wall: meshes as they are, a cylinder as 64 facets, a plane as the polygon in which it cuts the box (slightly
/// enlarged; none when it misses the box). In the wall's own frame at t = 0: the caller moves them.
std::vector<Triangle> tessellate(const WallShape& shape, const Box& box);

/// \throws WorkError naming the file when the system refuses.
void write_grains_vtp(const std::filesystem::path& file, const VtkGrains& grains);
void write_walls_vtp(const std::filesystem::path& file, const VtkWalls& walls);

/// grains_<frame>.vtp and walls_<frame>.vtp in `folder` (which must exist).
void write_vtk_frame(const std::filesystem::path& folder, int frame, const VtkGrains& grains, const VtkWalls& walls);
/// grains.pvd and walls.pvd for frames 0 … times.size() - 1; call after each frame (a resumed run passes all times from the start on).
void write_vtk_index(const std::filesystem::path& folder, std::span<const double> frame_times_s);
}  // namespace venato::dem
