#include "dem/contact/kernels/mixing.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "dem/contact/kernels/restitution.h"

namespace venato::dem {
EffectiveModuli effective_moduli(const Material& a, const Material& b) {
  auto young = [](const Material& m) { return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus_pa; };
  auto shear = [](const Material& m) { return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.young_modulus_pa; };
  return {1 / (young(a) + young(b)), 1 / (shear(a) + shear(b))};
}

namespace {
void require(bool ok, const std::string& who, const char* what, double value, const char* limits) {
  if (!ok) throw UsageError("material " + who + ": " + what + " = " + std::to_string(value) + " is outside " + limits);
}
}  // namespace

void check_materials(const MaterialTable& t) {
  const std::size_t n = t.materials.size();
  if (n == 0) throw UsageError("the material table is empty: a DEM case needs at least one material");
  if (t.pairs.size() != n * n)
    throw UsageError("the material table has " + std::to_string(n) + " materials but " + std::to_string(t.pairs.size()) + " pair entries; it needs " +
                     std::to_string(n * n) + " (row-major, symmetric)");
  for (const Material& m : t.materials) {
    require(m.young_modulus_pa > 0 && std::isfinite(m.young_modulus_pa), "'" + m.name + "'", "Young's modulus [Pa]", m.young_modulus_pa, "(0, inf)");
    require(m.poisson_ratio >= 0 && m.poisson_ratio < 0.5, "'" + m.name + "'", "Poisson's ratio", m.poisson_ratio, "[0, 0.5)");
  }
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      const PairProperties &p = t.pairs[a * n + b], &q = t.pairs[b * n + a];
      const std::string who = "pair '" + t.materials[a].name + "' / '" + t.materials[b].name + "'";
      require(p.restitution >= kLowestRestitution && p.restitution <= 1, who, "restitution", p.restitution, "[0.01, 1]");
      require(p.sliding_friction >= 0 && std::isfinite(p.sliding_friction), who, "sliding friction", p.sliding_friction, "[0, inf)");
      require(p.rolling_friction >= 0 && std::isfinite(p.rolling_friction), who, "rolling friction", p.rolling_friction, "[0, inf)");
      require(p.rolling_damping_ratio >= 0 && std::isfinite(p.rolling_damping_ratio), who, "rolling damping ratio", p.rolling_damping_ratio,
              "[0, inf)");
      if (p.restitution != q.restitution || p.sliding_friction != q.sliding_friction || p.rolling_friction != q.rolling_friction ||
          p.rolling_damping_ratio != q.rolling_damping_ratio)
        throw UsageError("material " + who + ": the table is not symmetric");
    }
}
}  // namespace venato::dem
