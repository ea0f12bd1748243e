#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include "base/rng.h"
namespace venato::line {

/// State of the flow at a point of the (y, z) plane.
struct FlowSample {
  double u_y = 0, u_z = 0;              ///< [m/s]
  double d_yy = 0, d_zz = 0, d_yz = 0;  ///< [m2/s], positive semi-definite
  double drift_y = 0, drift_z = 0;      ///< div D + D grad ln(phi) [m/s]
  double d_xx = 0;                      ///< [m2/s] across the slice
};
struct Tracer {
  double y = 0, z = 0;  ///< [m]
  double time_s = 0;
  double spread_x_m2 = 0;  ///< integral of 2 d_xx dt: the variance of the shift across
};
struct NormalPair {
  double a, b;
};

/// One step of the Ito equation dX = [u + div D + D grad ln phi] dt + sqrt(2) B dW, B B^T = D (multiscale.md eq. 1.3): Euler-Maruyama noise and
/// drift, advection with the velocity at the middle of the step (noise included, which makes shear-diffusion coupling second order: sigma_xz of FP1
/// is exact at any step). With phi the solid fraction, n ~ phi is stationary wherever div(phi u) = 0 (well mixed). Field: FlowSample sample(y, z)
/// const; void velocity(y, z, double& u_y, double& u_z) const; for points inside or, for the middle of a step, a fraction of a step outside. \return
/// the displacement; the caller applies walls.
template <class Field>
void propose_step(const Field& field, const FlowSample& here, const Tracer& t, double tau_s, NormalPair normal, double& dy, double& dz) {
  const double scale = std::sqrt(2 * tau_s);
  const double b_yy = std::sqrt(std::max(0.0, here.d_yy));
  const double b_zy = b_yy > 0 ? here.d_yz / b_yy : 0;
  const double b_zz = std::sqrt(std::max(0.0, here.d_zz - b_zy * b_zy));
  const double jump_y = here.drift_y * tau_s + scale * b_yy * normal.a, jump_z = here.drift_z * tau_s + scale * (b_zy * normal.a + b_zz * normal.b);
  double u_y, u_z;
  field.velocity(t.y + 0.5 * (here.u_y * tau_s + jump_y), t.z + 0.5 * (here.u_z * tau_s + jump_z), u_y, u_z);
  dy = u_y * tau_s + jump_y;
  dz = u_z * tau_s + jump_z;
}

/// Folds a coordinate back between two reflecting walls.
inline double fold(double v, double low, double high) {
  while (v < low || v > high) v = v < low ? 2 * low - v : 2 * high - v;
  return v;
}

/// Tracer i of a run over `steps` equal steps between walls; Field additionally gives void confine(double& y, double& z) const.
/// Random numbers are keyed by tracer: pair k belongs to step k, so bits depend on neither threads nor other tracers.
template <class Field>
Tracer carry(const Field& field, Tracer t, double tau_s, std::int64_t steps, std::uint64_t seed, std::uint64_t tracer) {
  Rng rng(seed, stream_id("line/tracer_walk"), tracer);
  for (std::int64_t k = 0; k < steps; ++k) {
    const FlowSample here = field.sample(t.y, t.z);
    const double a = rng.normal(), b = rng.normal();
    double dy, dz;
    propose_step(field, here, t, tau_s, {a, b}, dy, dz);
    t.y += dy;
    t.z += dz;
    field.confine(t.y, t.z);
    t.spread_x_m2 += 2 * here.d_xx * tau_s;
    t.time_s += tau_s;
  }
  return t;
}
}  // namespace venato::line
