#pragma once
#include <string>
#include <vector>
#include "line/config/line_config.h"
namespace venato::line {

/// Everything that can be wrong with a line although its config reads well: pictures, layout of the dosing heads.
/// \throws ConfigError with all issues.
void check_line(const LineConfig& config);

struct StageCost {
  std::string name;
  dem::CaseCost cost{};
  bool in_store = false;
};
struct LineCost {
  std::vector<StageCost> stages;
  double dem_seconds = 0;       ///< of the stages that are not in the store
  double bed_memory_bytes = 0;  ///< of the whole-slab part
};
LineCost estimate_line_cost(const LineConfig& config, const Store& store, int threads);
std::string cost_table(const LineConfig& config, const LineCost& cost);
}  // namespace venato::line
