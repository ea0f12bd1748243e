#pragma once
#include <vector>
#include "base/error.h"
#include "line/config/line_config.h"
namespace venato::line {
/// Does every stage get what it consumes? The first is handed commands, the last must make a slab, the first must be able to plan commands.
/// Each issue names the impossible pair and the stages that would fit between. Nothing runs before this is empty.
std::vector<ConfigIssue> check_chain_order(const std::vector<ConfiguredStage>& chain, const std::vector<StageDescriptor>& known);
}  // namespace venato::line
