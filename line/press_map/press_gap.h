#pragma once
#include <vector>
namespace venato::line {
/// rho = a + b ln(P / MPa) and its inverse (multiscale.md 3.3). Valid above about 1 MPa.
double pressed_density(double pressure_pa, double a_kg_m3, double b_kg_m3);
double pressure_of_density(double density_kg_m3, double a_kg_m3, double b_kg_m3);

/// Gap at which the area-weighted mean pressure of columns with these masses is `peak_pressure_pa`. Newton on the logarithm of the mean, which is
/// convex in 1 / gap. \param mass_kg_m2 per pressed area; \param area weights \throws UsageError when the density law gives nothing positive at the
/// peak pressure
double common_gap(const std::vector<double>& mass_kg_m2, const std::vector<double>& area, double peak_pressure_pa, double a_kg_m3, double b_kg_m3);
}  // namespace venato::line
