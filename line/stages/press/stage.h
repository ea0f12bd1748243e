#pragma once
#include "line/stages/stage_api.h"
namespace venato::line::press {
StageDescriptor descriptor();
}  // namespace venato::line::press
