#include "dem/contact/liggghts_hertz/law.h"

#include "dem/contact/kernels/mixing.h"
#include "dem/contact/kernels/restitution.h"

namespace venato::dem {
LiggghtsHertz make_liggghts_hertz(const MaterialTable& table, int a, int b) {
  const EffectiveModuli m = effective_moduli(table.materials[static_cast<std::size_t>(a)], table.materials[static_cast<std::size_t>(b)]);
  const PairProperties& p = table.pair(a, b);
  return {m.young_pa, m.shear_pa, textbook_damping(p.restitution), p.sliding_friction, p.rolling_friction, p.rolling_damping_ratio};
}
}  // namespace venato::dem
