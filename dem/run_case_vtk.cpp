#include <cmath>

#include "base/io/atomic_file.h"
#include "dem/run_case_state.h"
#include "dem/vtk/vtk_writer.h"

namespace venato::dem {
void write_vtk(CaseRun& run) {
  std::vector<Vec3> position, velocity;
  std::vector<double> radius;
  std::vector<std::int32_t> species;
  std::vector<std::int64_t> id;
  for (const GrainState& g : run.sim.grains()) {
    Vec3 p = g.position_m;  // wrapped back into the box: what one wants to look at
    for (int a = 0; a < 3; ++a)
      if (run.c.box.periodic[a]) {
        const double length = run.c.box.high[a] - run.c.box.low[a];
        p[a] -= std::floor((p[a] - run.c.box.low[a]) / length) * length;
      }
    position.push_back(p), velocity.push_back(g.velocity_m_s), radius.push_back(g.radius_m), species.push_back(g.species), id.push_back(g.id);
  }
  VtkWalls walls;
  for (std::size_t k = 0; k < run.c.walls.size(); ++k) {
    const int wall = static_cast<int>(k);
    if (!run.sim.wall_present(wall)) continue;
    for (const Triangle& t : tessellate(run.c.walls[k].shape, run.c.box)) {
      walls.triangles.push_back({run.sim.wall_point_m(wall, t.a), run.sim.wall_point_m(wall, t.b), run.sim.wall_point_m(wall, t.c)});
      walls.wall.push_back(wall);
    }
  }
  make_output_folder(run.options.vtk_folder);
  write_vtk_frame(run.options.vtk_folder, static_cast<int>(run.vtk_times_s.size()), {position, velocity, radius, species, id}, walls);
  run.vtk_times_s.push_back(run.sim.time_s());
  write_vtk_index(run.options.vtk_folder, run.vtk_times_s);
}
}  // namespace venato::dem
