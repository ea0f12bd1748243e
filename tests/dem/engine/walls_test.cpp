/// Wall geometry and motion (verification.md 6).
#include <gtest/gtest.h>

#include <algorithm>

#include "dem/walls/motion.h"
#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
using namespace scene;
const Vec3 kGravity(0, 0, -9.81);

Triangle tri(const Vec3& a, const Vec3& b, const Vec3& c) { return {a, b, c}; }

/// Coplanar triangles over [-8, 8] x [-8, 8] mm: a fan at the origin, T-junctions on both sides of it, very unequal sizes.
std::vector<Triangle> patchwork() {
  const double u = 1e-3;
  auto p = [u](double x, double y) { return Vec3(x * u, y * u, 0); };
  return {tri(p(-8, -8), p(8, -8), p(8, -1)), tri(p(-8, -8), p(8, -1), p(-8, -1)),  // long ones below: T-junctions along y = -1
          tri(p(-8, -1), p(-2, -1), p(0, 0)), tri(p(-2, -1), p(1, -1), p(0, 0)),   tri(p(1, -1), p(8, -1), p(0, 0)),  // fan at the origin
          tri(p(8, -1), p(8, 8), p(0, 0)),    tri(p(8, 8), p(-3, 8), p(0, 0)),     tri(p(-3, 8), p(-8, 8), p(0, 0)),
          tri(p(-8, 8), p(-8, -1), p(0, 0))};
}

struct Track {
  std::vector<Vec3> position, spin, force;
  std::size_t most_contacts = 0;
};
Track roll_over(const Wall& wall, const Vec3& start, const Vec3& velocity) {
  Simulation sim(setup(2e-6, powder(0.5, 0.4, 0.05, 0.3), kGravity));
  sim.add_wall(wall);
  const double r = 3e-4;
  const GrainId g = sim.add_grain(grain(start + Vec3(0, 0, r - 1e-7), r, velocity));
  Track t;
  for (int k = 0; k < 100; ++k) {
    sim.step(150);
    t.position.push_back(sim.grain(g).position_m), t.spin.push_back(sim.grain(g).spin_rad_s), t.force.push_back(sim.grain(g).force_n);
    t.most_contacts = std::max(t.most_contacts, sim.contacts().size());
  }
  return t;
}
/// 6.3: the mesh is the plane. 1e-9 relative to size, speed and weight: only rounding of the nearest point differs.
TEST(Mesh, CoplanarTrianglesAreThePlane) {
  const Vec3 paths[][2] = {{Vec3(-4e-3, -1e-3, 0), Vec3(0.3, 0, 0)},     // along the T-junction edge
                           {Vec3(-4e-3, -2e-3, 0), Vec3(0.2, 0.1, 0)},   // through the fan vertex exactly
                           {Vec3(2e-3, -3e-3, 0), Vec3(-0.1, 0.25, 0)},  // across several edges
                           {Vec3(-4e-3, -4e-3 * 6.5 / 16 + 1e-5, 0), Vec3(0.3, 0.02, 0)}};
  for (const auto& path : paths) {
    const Track a = roll_over(plane(), path[0], path[1]), b = roll_over(mesh(patchwork()), path[0], path[1]);
    EXPECT_EQ(b.most_contacts, 1u);
    for (std::size_t k = 0; k < a.position.size(); ++k) {
      EXPECT_LT((a.position[k] - b.position[k]).norm(), 1e-9 * 1e-3) << k;
      EXPECT_LT((a.spin[k] - b.spin[k]).norm(), 1e-9 * 1e3) << k;
      EXPECT_LT((a.force[k] - b.force[k]).norm(), 1e-9 * 1e-3) << k;
    }
  }
}
/// The same plate moving and turning in its own plane is not a plane at rest: friction drags the grain (so the test above is not blind).
TEST(Mesh, TwoSided) {
  Simulation sim(setup(2e-6, powder(), -kGravity));
  sim.add_wall(mesh(patchwork()));
  const GrainId g = sim.add_grain(grain(Vec3(1e-3, 1e-3, -3.5e-4), 3e-4));
  sim.step(20000);
  EXPECT_NEAR(sim.grain(g).position_m.z(), -3e-4, 1e-6);
}

/// 6.4: normals from the nearest point, one contact on convex features, two in a concave corner. 1e-9.
TEST(Mesh, ConvexEdgeVertexAndConcaveCorner) {
  const double s = 5e-3, r = 3e-4;
  auto contacts = [&](const std::vector<Triangle>& t, const Vec3& at) {
    Simulation sim(setup(1e-6));
    sim.add_wall(mesh(t));
    sim.add_grain(grain(at, r));
    sim.evaluate_forces();
    return sim.contacts();
  };
  // corner of a block filling x < 0, y < 0, z < 0
  const Vec3 o(0, 0, 0), x(-s, 0, 0), y(0, -s, 0), z(0, 0, -s), xy = x + y, xz = x + z, yz = y + z;
  const std::vector<Triangle> block{tri(o, x, xy), tri(o, xy, y), tri(o, z, xz), tri(o, xz, x), tri(o, y, yz), tri(o, yz, z)};
  const Vec3 edge = Vec3(0.6, 0, 0.8) * (0.98 * r) + Vec3(0, -1e-3, 0), vertex = Vec3(1, 2, 2) / 3 * (0.97 * r);
  const auto on_edge = contacts(block, edge), on_vertex = contacts(block, vertex);
  ASSERT_EQ(on_edge.size(), 1u);
  EXPECT_LT((on_edge[0].normal + Vec3(0.6, 0, 0.8)).norm(), 1e-9);
  EXPECT_NEAR(on_edge[0].overlap_m, 0.02 * r, 1e-9 * r);
  ASSERT_EQ(on_vertex.size(), 1u);
  EXPECT_LT((on_vertex[0].normal + Vec3(1, 2, 2) / 3).norm(), 1e-9);
  // inside corner: floor and wall
  const std::vector<Triangle> corner{tri(Vec3(-s, 0, 0), Vec3(s, 0, 0), Vec3(s, s, 0)), tri(Vec3(-s, 0, 0), Vec3(s, s, 0), Vec3(-s, s, 0)),
                                     tri(Vec3(-s, 0, 0), Vec3(s, 0, s), Vec3(s, 0, 0)), tri(Vec3(-s, 0, 0), Vec3(-s, 0, s), Vec3(s, 0, s))};
  const auto two = contacts(corner, Vec3(1e-4, 0.99 * r, 0.98 * r));
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NEAR(two[0].overlap_m + two[1].overlap_m, 0.03 * r, 1e-9 * r);
}
TEST(Mesh, RotatingMeshCarriesAndFloorForceIsTheWeight) {
  Simulation sim(setup(4e-6, powder(0.3, 0.6, 0.1, 0.3), kGravity));
  Wall w = mesh(patchwork());
  w.motion.rotation_rad_s = Vec3(0, 0, 5);
  w.motion.rotation_centre = Vec3(0, 0, 0);
  sim.add_wall(w);
  const double r = 3e-4, m = 4.0 / 3 * std::numbers::pi * r * r * r * 1900;
  // Starts with the turntable: stays on its circle because 25 / s^2 * 2 mm << mu g (it may creep by the rolling spring only).
  const GrainId g = sim.add_grain(grain(Vec3(2e-3, 0, r - 1e-7), r, Vec3(0, 5 * 2e-3, 0), Vec3(0, 0, 5)));
  sim.step(25000);  // 0.1 s = 0.5 rad
  const Vec3 p = sim.grain(g).position_m;
  EXPECT_NEAR(std::atan2(p.y(), p.x()), 0.5, 5e-3);
  EXPECT_NEAR(sim.wall_load(0).force_n.z() / (-m * 9.81), 1, 1e-4);  // 6.9
}

/// 6.5: R* = R inside a cylinder; the static overlap is that on a plane.
TEST(Cylinder, GrainAtTheBottomInside) {
  Simulation sim(setup(2e-6, powder(0.2), kGravity));
  Wall w;
  w.name = "drum";
  w.shape = CylinderShape{Vec3(0, -0.01, 0), Vec3::UnitY(), 0.02, 0.01, true};
  sim.add_wall(w);
  const double r = 3e-4, m = 4.0 / 3 * std::numbers::pi * r * r * r * 1900, young = 1e7 / (2 * (1 - 0.0625));
  const double d = std::pow(3 * m * 9.81 / (4 * young * std::sqrt(r)), 2.0 / 3);
  const GrainId g = sim.add_grain(grain(Vec3(0, 0, -0.01 + r - d), r));
  sim.step(20000);
  EXPECT_NEAR(-sim.grain(g).position_m.z(), 0.01 - r + d, 1e-9 * 0.01);
}
TEST(Cylinder, OutsideAndOpenEnds) {
  Simulation sim(setup(1e-6));
  Wall w;
  w.name = "post";
  w.shape = CylinderShape{Vec3(0, 0, 0), Vec3::UnitZ(), 0.01, 0.002, false};
  sim.add_wall(w);
  const double r = 3e-4;
  sim.add_grain(grain(Vec3(0.002 + 0.9 * r, 0, 0.005), r));  // on the side
  sim.add_grain(grain(Vec3(0.002, 0, 0.01 + 0.95 * r), r));  // on the rim
  sim.add_grain(grain(Vec3(0, 0.0019, 0.01 + 1.5 * r), r));  // above the open end
  sim.evaluate_forces();
  const auto c = sim.contacts();
  ASSERT_EQ(c.size(), 2u);
  EXPECT_NEAR(c[0].overlap_m, 0.1 * r, 1e-12);
  EXPECT_LT((c[0].normal + Vec3::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(c[1].overlap_m, 0.05 * r, 1e-12);
  EXPECT_LT((c[1].normal + Vec3::UnitZ()).norm(), 1e-9);
}

/// 6.2: take-off and landing phase of a grain on a vibrating plate. The table holds for a plate that is hard against gravity: with E = 1e9 the static
/// overlap is 2e-4 of the amplitude; 0.5 % instead of 0.2 % because the table ends the contact at zero load, a Hertz spring at zero overlap.
TEST(Motion, VibratingPlateTakeOffAndLanding) {
  const double table[][3] = {{1.5, .729728, 4.295944}, {2.0, .523599, 5.182450}, {3.0, .339837, 6.307445}};
  for (const auto& row : table) {
    MaterialTable m = powder(0.02, 0.5, 0, 0);
    m.materials[0].young_modulus_pa = 1e9;
    const double hz = 50, w = 2 * std::numbers::pi * hz, amplitude = row[0] * 9.81 / (w * w), r = 2e-4, dt = 2.5e-7;
    Simulation sim(setup(dt, m, kGravity));
    Wall plate = plane();
    plate.motion.vibration_amplitude_m = Vec3(0, 0, amplitude);
    plate.motion.vibration_hz = hz;
    sim.add_wall(plate);
    sim.add_grain(grain(Vec3(0, 0, r), r, Vec3(0, 0, amplitude * w)));  // starts with the plate: no kick at t = 0
    double off = 0, on = 0;
    sim.step(static_cast<std::int64_t>(0.1 / w / dt));
    while (sim.time_s() * w < 7 && on == 0) {
      sim.step();
      const bool touching = !sim.contacts().empty() && sim.contacts()[0].normal_force_n > 0;
      if (!touching && off == 0) off = sim.time_s() * w;
      if (touching && off > 0 && sim.time_s() * w > off + 0.5) on = sim.time_s() * w;
    }
    EXPECT_NEAR(off / row[1], 1, 5e-3) << row[0];
    EXPECT_NEAR(on / row[2], 1, 2e-3) << row[0];
  }
}
TEST(Motion, VibrationScheduleRestartsAndComesToRestAtZero) {
  WallMotion m;
  m.vibration_amplitude_m = Vec3(0, 0, 1e-3);
  m.vibration_hz = 100;
  m.vibrate_when = {{0.1, 0.123}, {0.2, 0.25}};
  EXPECT_EQ(vibration_offset(m, 0.05).z(), 0);
  EXPECT_NEAR(vibration_offset(m, 0.1025).z(), 1e-3, 1e-12);                                          // a quarter period after `on`
  EXPECT_NEAR(vibration_offset(m, 0.1244).z(), 1e-3 * std::sin(2 * std::numbers::pi * 2.44), 1e-12);  // finishes its half swing …
  EXPECT_EQ(vibration_offset(m, 0.1251).z(), 0);                                                      // … and stops at zero
  EXPECT_NEAR(vibration_offset(m, 0.2025).z(), 1e-3, 1e-12);                                          // starts anew
  EXPECT_EQ(vibration_offset(m, 0.26).z(), 0);
}
/// 4.2: a grain dropped on a belt of speed V: v = 2V/7, wR = 5V/7 at t = 2V/(7 mu g). 0.5 %.
TEST(Motion, BeltSetsAGrainRolling) {
  const double belt = 0.2, mu = 0.3, r = 5e-4, t = 2 * belt / (7 * mu * 9.81), dt = 1e-6;
  Simulation sim(setup(dt, powder(0.3, mu, 0, 0), kGravity));
  Wall w = plane();
  w.motion.surface_velocity_m_s = Vec3(0, belt, 0);
  sim.add_wall(w);
  const double m = 4.0 / 3 * std::numbers::pi * r * r * r * 1900, young = 1e7 / (2 * (1 - 0.0625));
  const GrainId g = sim.add_grain(grain(Vec3(0, 0, r - std::pow(3 * m * 9.81 / (4 * young * std::sqrt(r)), 2.0 / 3)), r));
  sim.step(static_cast<std::int64_t>(0.5 * t / dt));
  EXPECT_NEAR(sim.grain(g).velocity_m_s.y() / (belt / 7), 1, 5e-3);  // half way: v = mu g t
  sim.step(static_cast<std::int64_t>(0.7 * t / dt));
  EXPECT_NEAR(sim.grain(g).velocity_m_s.y() / (2 * belt / 7), 1, 5e-3);
  EXPECT_NEAR(-sim.grain(g).spin_rad_s.x() * r / (-5 * belt / 7), 1, 5e-3);  // the belt drags the underside forward: backward spin
}
TEST(Motion, TrackAndIntervals) {
  Simulation sim(setup(1e-4));
  Wall w = plane(Vec3(0, 0, -1));
  w.motion.track = {{0, Vec3::Zero()}, {0.1, Vec3(0, 0.02, 0)}, {0.2, Vec3(0, 0.02, 0.01)}};
  w.motion.velocity_m_s = Vec3(1, 0, 0);
  w.motion.translate_when = {{0.05, 0.1}, {0.2, 0.3}};
  sim.add_wall(w);
  sim.step(1500);
  EXPECT_LT((sim.wall_offset_m(0) - Vec3(0.05, 0.02, 0.005)).norm(), 1e-12);
}
TEST(Motion, WallIsThereOnlyWhilePresent) {
  Simulation sim(setup(1e-5, powder(), kGravity));
  Wall w = plane();
  w.present = {0, 0.01};
  sim.add_wall(w);
  const GrainId g = sim.add_grain(grain(Vec3(0, 0, 3e-4), 3e-4));
  sim.step(1000);
  EXPECT_GT(sim.grain(g).position_m.z(), 2.9e-4);
  sim.step(2000);  // falls g t^2 / 2 = 2 mm in 20 ms
  EXPECT_NEAR(sim.grain(g).position_m.z(), 3e-4 - 0.5 * 9.81 * 4e-4, 2e-5);
}
TEST(Walls, BadShapesAreRefusedByName) {
  Simulation sim(setup(1e-5));
  for (Wall w : {plane(Vec3::Zero(), Vec3::Zero()), mesh({})}) {
    w.name = "hopper";
    try {
      sim.add_wall(w);
      ADD_FAILURE() << "accepted";
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("'hopper'"), std::string::npos);
    }
  }
}
}  // namespace
}  // namespace venato::dem
