#pragma once
#include <optional>
#include <string>
#include "graphics/rectify/camera.h"
#include "sync/registration/registration.h"
#include "sync/score/score.h"
#include "sync/score/shape.h"
#include "sync/score/visibility.h"
#include "sync/score/zones.h"
namespace venato::sync {

struct CameraReport {
  graphics::SolvedView view;
  double visible = 0;  ///< 0..1 share of the slab that is scored
};

/// Everything that score.json says. Absent metrics and NaN become null.
struct ScoreReport {
  std::optional<Metrics> before, after, best_reachable;
  std::optional<Metrics> pose_only;  ///< told under "details"
  std::string before_definition, after_definition, best_reachable_definition;
  std::optional<EdgeWidths> body_edge, print_edge;  ///< 10-90 % edge widths, told under "details"
  std::optional<SlabScore> zones;                   ///< of `after`: verdicts by zone, told under "verdict" and "details"
  Tolerance tolerance;                              ///< that they were judged by
  std::optional<VisibilityReport> visibility;       ///< under "details"; none when the print's colours are not known
  std::string evidence;                             ///< what was compared, under "details"
  std::optional<CameraReport> camera;               ///< told under "details", when the slab was seen by one
};

/// The text of score.json: "before", "after", "best_reachable" (centreline_error_mm {median, p95}, matched_length, boundary_f1 {1mm, 2mm, 3mm},
/// dice), "registration" {success, reason, confidence; graphic_lies and slab_stretch on
/// success}, then definitions and details (further metrics with unit in their names, gates, zones).
std::string score_json_text(const ScoreReport& report, const Registration& registration);
}  // namespace venato::sync
