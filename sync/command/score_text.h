#pragma once
#include <optional>
#include <string>
#include "sync/registration/registration.h"
#include "sync/score/score.h"
namespace venato::sync {

/// Everything that score.json says. Absent metrics and NaN become null.
struct ScoreReport {
  std::optional<Metrics> before, after, best_reachable;
  std::optional<Metrics> pose_only;  ///< told under "details"
  std::string before_definition, after_definition, best_reachable_definition;
  std::string evidence;  ///< what was compared, under "details"
};

/// The text of score.json: "before", "after", "best_reachable" (centreline_error_mm {median, p95}, matched_length, boundary_f1 {1mm, 2mm, 3mm},
/// dice), "registration" {success, reason, confidence}, then definitions and details (further metrics with unit in their names, gates, zones).
std::string score_json_text(const ScoreReport& report, const Registration& registration);
}  // namespace venato::sync
