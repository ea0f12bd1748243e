#pragma once
#include <vector>
#include "sync/registration/features.h"
namespace venato::sync {

/// One place where the slab might lie in the graphic.
struct PoseCandidate {
  Transform pose;      ///< affine part only
  double score = 0;    ///< |masked NCC| * sqrt(overlap share): what candidates are ranked by
  double ncc = 0;      ///< masked NCC, signed
  double overlap = 0;  ///< share of the valid slab inside the valid graphic
  bool from_gradient = false;
  int turn = 0;  ///< flip * 4 + quarter turns
};
struct PoseSearch {
  std::vector<PoseCandidate> candidates;  ///< best first per feature, at most `keep` each, distinct places
  double gradient_peak_ratio = 0;         ///< best / next best score more than 60 mm away or in another turn
  double signed_peak_ratio = 0;
};
/// Exhaustive masked NCC (Padfield 2012) by FFT over flips, quarter turns, angles and scales of `config`, near `pitch_m`.
/// \param polarity_known  signed feature: only positive correlation counts
/// Source: registration_print.md 1.3 step 1; D. Padfield, IEEE Trans. Image Process. 21 (2012) 2706.
PoseSearch search_poses(const Features& green, const Features& print, double pitch_m, const RegistrationConfig& config, bool polarity_known, int keep,
                        int threads);
}  // namespace venato::sync
