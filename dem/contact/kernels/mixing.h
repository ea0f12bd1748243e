#pragma once
#include "dem/material.h"

namespace venato::dem {

/// Effective moduli of a material pair [Pa]: 1/Y* = sum (1-nu^2)/E, 1/G* = sum 2(2-nu)(1+nu)/E. Source: verification.md 1.1 (Di Renzo & Di Maio
/// 2005).
struct EffectiveModuli {
  double young_pa, shear_pa;
};
EffectiveModuli effective_moduli(const Material& a, const Material& b);

/// Checks sizes, symmetry, limits. \throws UsageError naming the material(s), the value and its limits.
void check_materials(const MaterialTable& table);
}  // namespace venato::dem
