#pragma once
#include "line/stages/stage_api.h"
namespace venato::line::powder_feeder {
StageDescriptor descriptor();
}  // namespace venato::line::powder_feeder
