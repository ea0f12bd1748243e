#include "dem/contact/hertz_mindlin/law.h"

#include "dem/contact/kernels/mixing.h"
#include "dem/contact/kernels/restitution.h"

namespace venato::dem {
HertzMindlin hertz_mindlin(double young_eff, double shear_eff, double beta, double friction, double rolling_friction, double rolling_damping) {
  const double damping = HertzMindlin::kDamping * beta;  // S_n = 2 Y* a, k_t = 8 G* a, k_r = 2.25 (4/3 Y* a) (mu_r R*)^2
  return {young_eff,
          shear_eff,
          beta,
          friction,
          rolling_friction,
          rolling_damping,
          damping * std::sqrt(2 * young_eff),
          damping * std::sqrt(8 * shear_eff),
          2 * rolling_damping * rolling_friction * std::sqrt(kEpsdStiffness * 4.0 / 3.0 * young_eff)};
}

HertzMindlin make_hertz_mindlin(const MaterialTable& table, int a, int b) {
  const EffectiveModuli m = effective_moduli(table.materials[static_cast<std::size_t>(a)], table.materials[static_cast<std::size_t>(b)]);
  const PairProperties& p = table.pair(a, b);
  return hertz_mindlin(m.young_pa, m.shear_pa, damping_for_restitution(p.restitution), p.sliding_friction, p.rolling_friction,
                       p.rolling_damping_ratio);
}
}  // namespace venato::dem
