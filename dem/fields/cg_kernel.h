#pragma once
/// The coarse-graining function of the continuum fields: a product of three equal 1-D kernels, each of compact support and normalised exactly.
///
///   phi(u) = 35 / (32 c) (1 - (u/c)^2)^3  for |u| < c = 3 w,   standard deviation w   (a Gaussian of the same w, cut at 3 w, is within 3 % of it)
/// A product, because the mean over a box-shaped cell is then a product of differences of the closed-form integral Phi(u): nothing is sampled, so
/// mass and momentum are exact on any grid. A polynomial, because line integrals over it are exact with Gauss' rule between its break points.
/// The mean over a cell is itself a coarse-graining function (phi convolved with the cell), so that all identities hold for it.
/// Source: Goldhirsch, Granular Matter 12 (2010) 239 (any positive normalised function will do).
#include <array>

namespace venato::dem {

inline constexpr double kKernelReach = 3;  ///< c / w: variance of (1 - q^2)^3 is c^2 / 9

/// q = u / c. phi times c.
inline double kernel_density(double q) {
  const double a = 1 - q * q;
  return a > 0 ? 35.0 / 32 * a * a * a : 0;
}
/// Integral of phi up to u; 0 below -c, 1 above c.
inline double kernel_integral(double q) {
  if (q <= -1) return 0;
  if (q >= 1) return 1;
  const double p = q * q;
  return 0.5 + 35.0 / 32 * q * (1 + p * (-1 + p * (0.6 - p / 7)));
}

/// Gauss-Legendre points and weights on [0, 1], six of them: exact up to degree 11.
struct GaussPoint {
  double at, weight;
};
inline constexpr std::array<GaussPoint, 6> kGauss{{{0.03376524289842397, 0.08566224618958525},
                                                   {0.16939530676686776, 0.18038078652406930},
                                                   {0.38069040695840156, 0.23395696728634552},
                                                   {0.61930959304159849, 0.23395696728634552},
                                                   {0.83060469323313224, 0.18038078652406930},
                                                   {0.96623475710157603, 0.08566224618958525}}};
}  // namespace venato::dem
