#pragma once
/// Where on the slab print and body line up, and how sure the slab's figures are.
#include <cstdint>
#include <vector>
#include "sync/score/score.h"
namespace venato::sync {

/// What a slab may be off before it is waste.
struct Tolerance {
  double good_median_m = 0.001, good_p95_m = 0.002, fair_p95_m = 0.003;  ///< of the centre-line distance
  double least_matched = 0.8;  ///< of the print's and of the body's vein length; distances on matched length alone would flatter
};
enum class Verdict { good, fair, low_match, bad, no_evidence };
const char* name(Verdict verdict);  ///< "good", "fair", "low_match", "bad", "no_evidence"

struct ZoneConfig {
  double zone_m = 0.2;           ///< about, each way: the slab is divided evenly
  double least_length_m = 0.05;  ///< of print and body centre line together; less is no evidence
  int resamples = 2000;          ///< of the bootstrap
  std::uint64_t seed = 1;
  Tolerance tolerance;
};
/// Distances in a rectangle: centre-line samples whose place is in it. NaN where nothing matched.
struct ZoneScore {
  double x_m = 0, y_m = 0, width_m = 0, height_m = 0;
  double print_length_m = 0, body_length_m = 0, matched = 0, found = 0;  ///< shares of the print's length matched, of the body's found by the print
  double median_m = 0, p95_m = 0, offset_m = 0;
  Verdict verdict = Verdict::no_evidence;
};
struct Interval {
  double low = 0, high = 0;  ///< NaN with fewer than two zones with matched length
};
struct SlabScore {
  int columns = 0, rows = 0;
  std::vector<ZoneScore> zones;  ///< row by row
  ZoneScore whole;
  /// 95 % intervals, bootstrap over zones: veins within a zone are off together, zones much less so. They tell what another slab of the same kind
  /// could read, not what the registration or the vein map itself may be wrong by.
  Interval median, p95, matched;
};
/// \param body, print as in score_masks() \throws UsageError as there, or for a zone or number of resamples that is not positive
/// Percentiles are read from classes of 0.01 mm. Source: Efron & Tibshirani (1993) ch. 8 (blocks resampled).
SlabScore score_zones(const graphics::Raster8& body, const graphics::Raster8& print, const ScoreConfig& config, const ZoneConfig& zones);
}  // namespace venato::sync
