#include "dem/contact/kernels/restitution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/expects.h"

namespace venato::dem {
namespace {
constexpr int kSteps = 1500;  // per elastic contact time: restitution good to 1e-7
constexpr int kLongest = 20 * kSteps;

double repulsion(double alpha, double x, double v) {
  if (x <= 0) return 0;
  const double root = std::sqrt(x);
  return std::max(0.0, x * root + alpha * std::sqrt(root) * v);
}
}  // namespace

HertzCollision collide_hertz(double alpha) {
  // Time is stretched as t = s^4: the force starts like t^(1/4), which would spoil the order of Runge-Kutta at s = t.
  const double d_el = std::pow(1.25, 0.4), t_el = 2.9432 * d_el;  // 15/16 * 4/3 = 1.25 with k_h = 4/3 Y* sqrt(R*) = 1
  const double ds = std::pow(t_el, 0.25) / kSteps;
  double s = 0, x = 0, v = 1, x_max = 0;
  auto slope = [&](double at, double xx, double vv, double& dx, double& dv) {
    const double rate = 4 * at * at * at;
    dx = rate * vv;
    dv = -rate * repulsion(alpha, xx, vv);
  };
  for (int step = 0; step < kLongest; ++step) {
    double k1x, k1v, k2x, k2v, k3x, k3v, k4x, k4v;
    slope(s, x, v, k1x, k1v);
    slope(s + ds / 2, x + ds / 2 * k1x, v + ds / 2 * k1v, k2x, k2v);
    slope(s + ds / 2, x + ds / 2 * k2x, v + ds / 2 * k2v, k3x, k3v);
    slope(s + ds, x + ds * k3x, v + ds * k3v, k4x, k4v);
    const double xn = x + ds / 6 * (k1x + 2 * k2x + 2 * k3x + k4x), vn = v + ds / 6 * (k1v + 2 * k2v + 2 * k3v + k4v);
    if (vn < 0 && repulsion(alpha, xn, vn) == 0) {
      // The force reaches zero inside this step; the velocity no longer changes there (second order), so the end value is the rebound speed.
      const double f0 = repulsion(alpha, x, v), xr = std::max(xn, 0.0), root = std::sqrt(xr);
      const double f1 = xn > 0 ? xr * root + alpha * std::sqrt(root) * vn : xn;  // signed: where it would have gone
      const double part = f0 > 0 ? f0 / (f0 - f1) : 0.0, s_end = s + part * ds;
      return {-vn, x_max / d_el, s_end * s_end * s_end * s_end / t_el};
    }
    x = xn, v = vn, s += ds;
    x_max = std::max(x_max, x);
  }
  return {0, x_max / d_el, INFINITY};  // overdamped: creeps out of the contact (alpha -> sqrt 5)
}

double restitution_at_step(double alpha, double steps, double phase) {
  VENATO_EXPECTS(steps > 1 && phase >= 0 && phase < 1);
  const double dt = 2.9432 * std::pow(1.25, 0.4) / steps;
  double x = -phase * dt, v = 1, a = 0;
  for (int k = 0; k < kLongest && !(x < 0 && v < 0); ++k) {
    v += 0.5 * dt * a;
    x += dt * v;
    a = -repulsion(alpha, x, v);
    v += 0.5 * dt * a;
  }
  return x < 0 && v < 0 ? -v : 0.0;
}

double textbook_damping(double restitution) {
  const double l = std::log(restitution);
  return -l / std::sqrt(l * l + std::numbers::pi * std::numbers::pi);
}

double damping_for_restitution(double restitution) {
  VENATO_EXPECTS(restitution >= kLowestRestitution && restitution <= 1);
  if (restitution == 1) return 0;
  const double root5 = std::sqrt(5.0);  // alpha = sqrt(5) beta
  double low = 0, high = 0.99999;       // beta = 1 is critical damping: no rebound at all
  double f_low = 1 - restitution, f_high = collide_hertz(root5 * high).restitution - restitution;
  for (int k = 0; k < 60 && std::abs(high - low) > 1e-12; ++k) {  // Illinois: bracketed secant
    const double mid = high - f_high * (high - low) / (f_high - f_low), f = collide_hertz(root5 * mid).restitution - restitution;
    if (std::abs(f) < 1e-10) return mid;
    if ((f > 0) == (f_high > 0)) {
      high = mid, f_high = f, f_low *= 0.5;
    } else {
      low = high, f_low = f_high, high = mid, f_high = f;
    }
  }
  return high;
}
}  // namespace venato::dem
