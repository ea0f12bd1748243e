#pragma once
#include <string>
#include <vector>

#include "dem/case.h"
namespace venato::dem {

/// Rayleigh time of a grain: a surface wave around half its circumference.
/// \param radius_m [m] > 0, density [kg/m^3], shear modulus G = E / (2 (1 + nu)) [Pa], Poisson ratio [-]
/// \return [s]. Source: seed paper; verification.md 0.4: t_R = pi R sqrt(rho / G) / (0.1631 nu + 0.8766).
double rayleigh_time(double radius_m, double density_kg_m3, double young_modulus_pa, double poisson_ratio);

/// Duration of an elastic Hertz contact.
/// \param m_eff [kg], r_eff [m], e_eff [Pa] (pair values; a wall has infinite mass and radius), speed [m/s] > 0 relative normal speed
/// \return [s]. Source: verification.md 0.4: t_H = 2.86828 (m*^2 / (R* Y*^2 v))^(1/5).
double hertz_time(double m_eff_kg, double r_eff_m, double e_eff_pa, double speed_m_s);

/// 1/Y* = (1 - nu_a^2) / E_a + (1 - nu_b^2) / E_b.
double effective_modulus(const Material& a, const Material& b);

/// Largest speed [m/s] that any point of a wall reaches by its own motion (translation, track, rotation about its centre over the shape's
/// extent, vibration, belt surface), parts added up. Planes are unbounded: their rotation is taken over the box.
double wall_speed(const Wall& wall, const Box& box);

/// The bounds behind choose_time_step, for logs and reports.
struct TimeStepBounds {
  double rayleigh_s = 0;  ///< smallest Rayleigh time over the powders' smallest grains
  double hertz_s = 0;     ///< smallest Hertz time over grain-grain pairs (at expected_max_speed) and grain-wall pairs (plus the wall's speed)
  double stiffening = 1;  ///< both are divided by it: sqrt(k2/k1) for laws that unload stiffer than they load
};
/// \throws UsageError for a case without grains, or with materials, sizes, speeds that give no time step.
TimeStepBounds time_step_bounds(const Case& c);

/// What becomes of the restitution of an impact at a given step: the damping is solved for exact time (design: the error at the production step is told).
struct StepRestitution {
  std::string a, b;            ///< materials
  double asked, got, largest_error;  ///< [-] mean over the phases of the step, and the largest difference from `asked` among them
  double steps_per_contact;
};
/// Of every pair of materials that can meet, for its smallest grains at expected_max_speed (walls: plus their own), Hertz-Mindlin; empty for other laws.
std::vector<StepRestitution> restitution_at_step(const Case& c, double time_step_s);
}  // namespace venato::dem
