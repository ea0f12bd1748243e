#pragma once
namespace venato::dem {

inline constexpr double kLowestRestitution = 0.01;  ///< below it the damping time is far shorter than any affordable step

/// One damped Hertz collision x'' = -max(0, x^1.5 + alpha x^0.25 x') in dimensionless form (m = k_h = v = 1): whatever R, Y, v are, the result is the
/// same (Antypov & Elliott 2011). Results as ratios to the elastic collision.
struct HertzCollision {
  double restitution, overlap_ratio, duration_ratio;
};
HertzCollision collide_hertz(double alpha);

/// Restitution of the same collision when it is integrated as the engine does (kick, drift, forces with half-step velocities, kick) with a finite step.
/// \param steps  [-] per elastic contact time, > 1
/// \param phase  [0, 1) of the step at which the spheres meet
/// Error against collide_hertz(): about 1.4e-2 at 10 steps and 6e-3 at 20 for e = 0.5 (verification.md 5.2).
double restitution_at_step(double alpha, double steps, double phase);

/// Damping factor beta of gamma_n = 2 sqrt(5/6) beta sqrt(S_n m*) such that the MEASURED restitution with the clamp F_n >= 0 equals `restitution`.
/// The textbook beta = -ln e / sqrt(ln^2 e + pi^2) would give 0.550 for e = 0.5 (verification.md 1.3), so the collision is integrated and inverted.
/// \param restitution [0.01, 1]  \return >= 0; relative error of the restitution < 1e-6
double damping_for_restitution(double restitution);

/// Textbook value, exact for a linear spring and for unclamped Hertz; used by EEPA as its source does.
double textbook_damping(double restitution);
}  // namespace venato::dem
