#pragma once
#include "line/stages/stage_api.h"
namespace venato::line::belt_transport {
StageDescriptor descriptor();
}  // namespace venato::line::belt_transport
