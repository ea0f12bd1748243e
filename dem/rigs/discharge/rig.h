#pragma once
/// Discharge flow through one or several holes or slots, one after the other in one run (seed paper, figure 5 right), and Beverloo's law through
/// them.
#include "dem/rigs/rig_api.h"
namespace venato::dem::rigs::discharge {
RigDescriptor descriptor();

struct Window {
  double size_m = 0;            ///< diameter of the hole, width of the slot
  double from_s = 0, to_s = 0;  ///< open
};
struct Config {
  bool slot = false;
  double slot_length_m = 0;   ///< slot only
  bool slot_periodic = true;  ///< slot only: it goes on through a periodic face, so no k d is lost at its ends
  std::string counter;        ///< plane below the opening
  std::vector<Window> openings;
  double settle_s = 0.05;  ///< after opening, before the flow counts
  bool has_bulk = false;
  Vec3 bulk_low = Vec3::Zero(), bulk_high = Vec3::Zero();  ///< where the bulk density is taken just before the first opening
  std::size_t bulk_plan = 0;                               ///< its snapshot plan
};
void read(ObjectReader& r, Case& c, Config& config);

/// W = C rho_b sqrt(g) (D - k d)^2.5 (hole) or C rho_b sqrt(g) L (D - k d)^1.5 (slot). Source: Beverloo 1961; verification: C 0.58 / 1.03, k 1.4.
inline constexpr double kHoleConstant = 0.58, kSlotConstant = 1.03, kEmptyAnnulus = 1.4;
double beverloo_kg_s(const Config& c, double size_m, double bulk_density_kg_m3, double gravity_m_s2, double grain_m, double constant, double k);

struct Flow {
  double mean_kg_s, standard_error_kg_s;  ///< of 8 equal blocks; NaN when fewer than 20 grains crossed
  double last_block_share;                ///< flow of the last block over the mean of the others
};
Flow flow_in_window(const std::vector<CounterRecord>& records, double from_s, double to_s);

/// Straight line W^(2/5) (hole) or W^(2/3) (slot, per metre) against D, weighted with the flows' errors: slope gives C, intercept k d.
struct BeverlooFit {
  double constant, constant_error;  ///< NaN without a bulk density
  double empty_m, empty_error_m;    ///< k d: the opening through which nothing would flow
  double r2;
};
BeverlooFit fit_beverloo(const Config& c, const std::vector<Flow>& flows, double bulk_density_kg_m3, double gravity_m_s2, double grain_m);
/// Mass of grains with their centre in the region over its volume [kg/m^3].
double bulk_density(const Snapshot& s, const Case& c, const Vec3& low, const Vec3& high);
RigResult measure(const Config& config, const Case& c, const CaseResult& r);
}  // namespace venato::dem::rigs::discharge
