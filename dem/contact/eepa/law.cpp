#include "dem/contact/eepa/law.h"

#include <string>

#include "base/error.h"
#include "dem/contact/kernels/mixing.h"
#include "dem/contact/kernels/restitution.h"

namespace venato::dem {
Eepa make_eepa(const MaterialTable& table, const EepaParameters& q, int a, int b) {
  if (!(q.stiffness_ratio_k2_k1 >= 1))
    throw UsageError("eepa: stiffness_ratio_k2_k1 = " + std::to_string(q.stiffness_ratio_k2_k1) + " is outside [1, inf): unloading is never softer");
  if (!(q.adhesion_ratio_kadh_k1 >= 0))
    throw UsageError("eepa: adhesion_ratio_kadh_k1 = " + std::to_string(q.adhesion_ratio_kadh_k1) + " is outside [0, inf)");
  if (q.exponent != 1 && q.exponent != 1.5) throw UsageError("eepa: exponent = " + std::to_string(q.exponent) + " is neither 1 nor 1.5");
  const EffectiveModuli m = effective_moduli(table.materials[static_cast<std::size_t>(a)], table.materials[static_cast<std::size_t>(b)]);
  const PairProperties& p = table.pair(a, b);
  return {m.young_pa,
          q.stiffness_ratio_k2_k1,
          q.adhesion_ratio_kadh_k1,
          q.exponent == 1 ? 1.0 : 0.0,
          q.constant_force_n,
          textbook_damping(p.restitution),
          p.sliding_friction,
          p.rolling_friction,
          p.rolling_damping_ratio};
}
}  // namespace venato::dem
