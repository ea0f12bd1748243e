#pragma once
/// Operators of the configured stages: from the store, or by DEM and then into the store.
#include <string>
#include "base/context.h"
#include "line/config/line_config.h"
namespace venato::line {

struct StageOperator {
  Operator op;
  std::string key;  ///< content hash in the store
  bool cached = false;
  double wall_s = 0;  ///< for run.json only, never stored with data
};
std::string operator_key(const LineConfig& config, const ConfiguredStage& stage);
/// \throws WorkError when the DEM fails; Interrupted with its checkpoints kept in the store.
StageOperator obtain_operator(const LineConfig& config, const ConfiguredStage& stage, Context& context);
}  // namespace venato::line
