// The width of the kernel: grains show below half a diameter, the surfaces of the bed above two; in between the fields do not depend on it. A settled
// bed of 16 diameters; fields at half its height. The plot is left in the build folder.
#include <gtest/gtest.h>

#include <cmath>

#include "base/io/atomic_file.h"
#include "dem/case_outputs/field_plots.h"
#include "dem/fields/field_recorder.h"
#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
constexpr double kDiameter = 1e-3;

Simulation settled_bed() {
  auto setup = scene::setup(5e-6, scene::powder(0.3, 0.5, 0.1), Vec3(0, 0, -9.81));
  setup.box.low = Vec3::Zero(), setup.box.high = Vec3(8e-3, 8e-3, 40e-3);
  setup.box.periodic[0] = setup.box.periodic[1] = true;
  Simulation sim(setup);
  sim.add_wall(scene::plane());
  for (int k = 0; k < 1280; ++k) {
    Rng rng(2, stream_id("tests/plateau/bed"), static_cast<std::uint64_t>(k));
    const int layer = k / 49;
    const Vec3 jitter = 0.05e-3 * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
    sim.add_grain(scene::grain(Vec3((k % 7 + 0.5) * 8e-3 / 7, (k / 7 % 7 + 0.5) * 8e-3 / 7, (layer + 0.6) * 1.1e-3) + jitter,
                               0.5 * kDiameter * (0.9 + 0.2 * rng.uniform())));
  }
  sim.step(60000);
  return sim;
}

TEST(Plateau, fields_of_a_bed_do_not_depend_on_the_width_between_half_and_two_diameters) {
  const Simulation sim = settled_bed();
  double fastest = 0;
  for (const GrainState& g : sim.grains()) fastest = std::max(fastest, g.velocity_m_s.norm());
  ASSERT_LT(fastest, 1e-3);
  Box box;
  box.low = Vec3::Zero(), box.high = Vec3(8e-3, 8e-3, 40e-3);
  box.periodic[0] = box.periodic[1] = true;
  FieldPlan plan;
  plan.width_m = kDiameter, plan.cell_m = Vec3(8e-3, 8e-3, 1e-3);
  FieldRecorder recorder(box, plan, Vec3(0, 0, -9.81), 1);
  recorder.take(sim);
  const FieldResult r = recorder.finish();
  write_text_atomically(std::filesystem::path(VENATO_BINARY_DIR) / "plateau.svg", plateau_svg("settled bed", r.plateau, kDiameter));
  const PlateauScan& p = r.plateau;
  double low = 1e30, high = 0, stress_low = 1e30, stress_high = 0, fine = 0;
  double at_one = 0, stress_at_one = 0;
  for (std::size_t k = 0; k < p.width_m.size(); ++k)
    if (std::abs(p.width_m[k] / kDiameter - 1) < 1e-9) at_one = p.density_kg_m3[k], stress_at_one = p.stress_zz_pa[k];
  ASSERT_GT(at_one, 0);
  for (std::size_t k = 0; k < p.width_m.size(); ++k) {
    const double w = p.width_m[k] / kDiameter, rho = p.density_kg_m3[k] / at_one, stress = p.stress_zz_pa[k] / stress_at_one;
    RecordProperty("w_over_d_" + std::to_string(k), std::to_string(w) + " density " + std::to_string(rho) + " stress " + std::to_string(stress));
    if (w > 0.49 && w < 2.01)
      low = std::min(low, rho), high = std::max(high, rho), stress_low = std::min(stress_low, stress), stress_high = std::max(stress_high, stress);
    if (w < 0.2) fine = std::max(fine, std::abs(rho - 1));
  }
  // One profile over 64 d^2: packing fluctuates by about 1 % from layer to layer; a stress linear in z is untouched by an even kernel.
  EXPECT_LT(high - low, 0.015);
  EXPECT_LT(stress_high - stress_low, 0.015);
  EXPECT_GT(fine, 0.03);  // far below a diameter there is no plateau: the grains themselves show
  // Bulk: density of random loose to close packing, and the stress is the weight above.
  EXPECT_GT(at_one / 1900, 0.54);
  EXPECT_LT(at_one / 1900, 0.64);
  double above = 0;
  for (const GrainState& g : sim.grains()) above += g.mass_kg * (g.position_m.z() > p.z_m ? 9.81 : 0) / 64e-6;
  EXPECT_NEAR(-stress_at_one / above, 1, 0.05);
}
}  // namespace
}  // namespace venato::dem
