// Uniaxial compression between a floor and a lid: the stress of the grains' contacts is the force on the plates, and the loading curve is steeper
// than one Hertz contact (1.5), since contacts are added. The exponent is reported, not limited.
#include <gtest/gtest.h>

#include "dem/fields/continuum.h"
#include "tests/dem/bulk_laws/powder_scenes.h"

namespace venato::dem::bulk {
namespace {
constexpr double kSide = 7 * kD;

TEST(Compression, plates_and_contacts_carry_the_same_stress) {
  SimulationSetup s = setup(powder(.5, .1, .5), Vec3(kSide, kSide, 1), true, true);
  Simulation sim(s);
  const int floor_at = sim.add_wall(plane(Vec3::Zero(), Vec3::UnitZ()));
  pour(sim, 700, Vec3::Zero(), Vec3(kSide, kSide, 0), 7);
  sim.step(16000);
  sim.set_gravity(Vec3::Zero());  // one stress over the height
  double surface = 0;
  for (const GrainState& g : sim.grains()) surface = std::max(surface, g.position_m.z() + g.radius_m);
  const double speed = 0.004;  // slow: the inertial number is checked below
  Wall lid = plane(Vec3(0, 0, surface), -Vec3::UnitZ());
  lid.motion.velocity_m_s = Vec3(0, 0, -speed);
  lid.motion.translate_when = {{sim.time_s(), 1e9}};
  const int lid_at = sim.add_wall(lid);
  std::vector<double> strain, stress;
  double worst_field = 0, worst_plates = 0, inertial = 0;
  for (int k = 0; k < 70; ++k) {
    const int steps = 1000;
    sim.step(steps);
    const double area = kSide * kSide, height = surface + sim.wall_offset_m(lid_at).z();
    const double floor = -sim.wall_load(floor_at).force_n.z() / area, top = sim.wall_load(lid_at).force_n.z() / area;
    if (top < 200) continue;  // loose: grains that do not yet touch are being pushed together
    Box box;
    box.low = Vec3::Zero(), box.high = Vec3(kSide, kSide, height);
    box.periodic[0] = box.periodic[1] = true;
    ContinuumSums sums(make_continuum_grid(box, Vec3(1, 1, kD), kD));
    sums.add(sim.grains(), sim.contacts());
    const ContinuumFields f = continuum_fields(sums);
    double middle = 0, n = 0;
    for (int c = 0; c < f.grid.n[2]; ++c)
      if (f.grid.centre_m(2, c) > 3.5 * kD && f.grid.centre_m(2, c) < height - 3.5 * kD)
        middle -= f.contact_stress_pa[static_cast<std::size_t>(c)][8], n += 1;
    middle /= n;
    worst_field = std::max(worst_field, std::abs(middle / (0.5 * (floor + top)) - 1));
    worst_plates = std::max(worst_plates, std::abs(floor / top - 1));
    inertial = std::max(inertial, speed / height * kD / std::sqrt(top / kDensity));
    strain.push_back(-sim.wall_offset_m(lid_at).z() / surface), stress.push_back(top);
  }
  ASSERT_GT(stress.size(), 10u);
  EXPECT_LT(inertial, 1e-3);      // quasi-static
  EXPECT_LT(worst_plates, 0.03);  // sound crosses the bed within a step of loading
  EXPECT_LT(worst_field, 0.02);   // Love-Weber stress against the plates
  EXPECT_GT(stress.back(), 20 * stress.front());
  for (std::size_t k = 1; k < stress.size(); ++k) EXPECT_GT(stress[k], 0.98 * stress[k - 1]);
  // sigma ~ (eps - eps_0)^n: eps_0 by the best straight line of the logarithms.
  double best = 0, exponent = 0;
  for (double e0 = 0; e0 < strain.front(); e0 += strain.front() / 200) {
    std::vector<double> x, y;
    for (std::size_t k = 0; k < strain.size(); ++k) x.push_back(std::log(strain[k] - e0)), y.push_back(std::log(stress[k]));
    const Line line = fit(x, y);
    if (line.r2 > best) best = line.r2, exponent = line.slope;
  }
  RecordProperty("exponent", std::to_string(exponent));
  RecordProperty("r2", std::to_string(best));
  RecordProperty("stress_pa_from_to", std::to_string(stress.front()) + " " + std::to_string(stress.back()));
  EXPECT_GT(best, 0.98);
}
}  // namespace
}  // namespace venato::dem::bulk
