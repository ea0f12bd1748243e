#pragma once
#include "sync/registration/pose_search.h"
namespace venato::sync {

/// A candidate after affine refinement by enhanced correlation (Evangelidis & Psarakis 2008, OpenCV findTransformECC).
struct RefinedPose {
  bool ok = false;
  std::string why_not;  ///< "" if ok
  Transform pose;       ///< affine part only
  double ecc = 0;       ///< correlation at the optimum, 0..1
  int polarity = 1;     ///< -1: the print is light where the slab is dark
  double overlap = 0;   ///< share of the valid slab inside the valid graphic
};
/// Coarse (8 mm) refinement of every candidate in every allowed polarity, fine (4 mm) refinement of the best two; returns the one with the
/// highest ECC value. Singular values of A must stay within [0.95, 1.06], the overlap above config.min_overlap.
/// \param green, print  signed evidence
/// \param factor_4mm  features' pixels per 4 mm
RefinedPose refine_poses(const Feature& green, const Feature& print, const std::vector<PoseCandidate>& candidates, int factor_4mm,
                         const RegistrationConfig& config, bool polarity_known, int threads);
/// ECC of the given affine map without optimising, at most `iterations` steps from it. Exposed for tests.
RefinedPose refine_affine(const Feature& green, const Feature& print, const Transform& start, int polarity, int iterations, double min_overlap);
}  // namespace venato::sync
