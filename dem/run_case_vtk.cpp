#include <cmath>

#include "base/io/atomic_file.h"
#include "dem/run_case_state.h"
#include "dem/vtk/vtk_writer.h"

namespace venato::dem {
Vec3 in_box(const Box& box, Vec3 p) {
  for (int a = 0; a < 3; ++a)
    if (box.periodic[a]) {
      const double length = box.high[a] - box.low[a];
      p[a] -= std::floor((p[a] - box.low[a]) / length) * length;
    }
  return p;
}

WallTriangles present_walls(const CaseRun& run) {
  WallTriangles walls;
  for (std::size_t k = 0; k < run.c.walls.size(); ++k) {
    const int wall = static_cast<int>(k);
    if (!run.sim.wall_present(wall)) continue;
    for (const Triangle& t : tessellate(run.c.walls[k].shape, run.c.box)) {
      walls.triangles.push_back({run.sim.wall_point_m(wall, t.a), run.sim.wall_point_m(wall, t.b), run.sim.wall_point_m(wall, t.c)});
      walls.wall.push_back(wall);
    }
  }
  return walls;
}

void write_vtk(CaseRun& run) {
  std::vector<Vec3> position, velocity;
  std::vector<double> radius;
  std::vector<std::int32_t> species;
  std::vector<std::int64_t> id;
  for (const GrainState& g : run.sim.grains()) {
    position.push_back(in_box(run.c.box, g.position_m));
    velocity.push_back(g.velocity_m_s), radius.push_back(g.radius_m), species.push_back(g.species), id.push_back(g.id);
  }
  WallTriangles now = present_walls(run);
  VtkWalls walls;
  walls.triangles = std::move(now.triangles);
  walls.wall = std::move(now.wall);
  make_output_folder(run.options.vtk_folder);
  write_vtk_frame(run.options.vtk_folder, static_cast<int>(run.vtk_times_s.size()), {position, velocity, radius, species, id}, walls);
  run.vtk_times_s.push_back(run.sim.time_s());
  write_vtk_index(run.options.vtk_folder, run.vtk_times_s);
}
}  // namespace venato::dem
