#pragma once
/// Tapped density: bulk density against the number of taps, Hausner ratio (seed paper, figure 5 left).
#include "dem/rigs/rig_api.h"
namespace venato::dem::rigs::tapped_density {
RigDescriptor descriptor();

struct Config {
  double centre_x_m = 0, centre_y_m = 0, radius_m = 0, floor_z_m = 0;  ///< upright cylinder at rest
  double first_tap_s = 0, period_s = 0;
  int taps = 0;
  std::size_t plan = 0;             ///< frames just before the first tap and at the end of every period
};
void read(ObjectReader& r, Case& c, Config& config);

inline constexpr int kWedges = 6, kRings = 3;
/// Bulk density per wedge [kg/m^3]: mass over volume, the height of each of three rings of equal area taken as twice the mean height of its grains
/// (exact for a column of even density, whatever the shape of the surface from ring to ring). NaN where a wedge is empty.
std::vector<double> wedge_densities(const Snapshot& s, const Case& c, const Config& config);

/// rho(n) = final - (final - poured) exp(-n / tau) by least squares; NaN with fewer than four points or when nothing changes.
struct TapFit {
  double poured, final_density, tau, r2;
};
TapFit fit_tapping(const std::vector<double>& density);   ///< [n] after n taps
RigResult measure(const Config& config, const Case& c, const CaseResult& r);
}  // namespace venato::dem::rigs::tapped_density
