#pragma once
#include "line/stages/stage_api.h"
namespace venato::line::piezo_discharge {
StageDescriptor descriptor();
}  // namespace venato::line::piezo_discharge
