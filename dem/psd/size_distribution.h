#pragma once
#include <cstdint>
#include <vector>
namespace venato::dem {

/// Two-parameter Weibull distribution of grain diameter BY MASS, cut at both ends and renormalised:
/// F_mass(d) = [W(d) - W(lower)] / [W(upper) - W(lower)],  W(d) = 1 - exp(-(d / scale)^shape).
/// The number density ~ d^(shape-4) diverges at 0 for shape <= 3, so a lower cut > 0 is mandatory.
struct SizeDistribution {
  double scale_m = 0;      ///< > 0
  double shape = 0;        ///< > 0
  double lower_cut_m = 0;  ///< > 0
  double upper_cut_m = 0;  ///< > lower cut; equal to the lower cut = monodisperse
};

double mass_cdf(const SizeDistribution& psd, double diameter_m);
double mass_quantile(const SizeDistribution& psd, double u);  ///< inverse of mass_cdf, u in [0,1]
/// Mean mass of a grain drawn by NUMBER [kg], coarse-grained diameters cg*d.
double mean_grain_mass(const SizeDistribution& psd, double density_kg_m3, double coarse_graining);
/// n diameters [m] (times coarse_graining) drawn by number so that their mass follows the mass law: inverse transform of the number CDF
/// (closed table, error < 1e-6), counter-based: grain `first_entity + k` always gets the same size for the same seed and stream.
std::vector<double> sample_diameters(const SizeDistribution& psd, double coarse_graining, std::size_t n, std::uint64_t seed, std::uint64_t stream,
                                     std::uint64_t first_entity = 0);
}  // namespace venato::dem
