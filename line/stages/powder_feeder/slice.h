#pragma once
#include "line/response/pulse_response.h"
#include "line/stages/powder_feeder/config.h"
namespace venato::line::powder_feeder {

/// When each powder's actuator is told to open and close: [powder][cycle].
std::vector<std::vector<PulseWindow>> feeding_schedule(const Config& c, std::size_t powders);
double case_duration(const Config& c);
/// Counters: 0 … K-1 below each outlet, K "landing" (removed). Species = powder.
dem::Case make_case(const Config& c, const LineBasics& basics);
Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& checkpoint_folder, Context& context);
}  // namespace venato::line::powder_feeder
