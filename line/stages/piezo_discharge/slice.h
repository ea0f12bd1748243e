#pragma once
#include "line/response/pulse_response.h"
#include "line/stages/piezo_discharge/config.h"
namespace venato::line::piezo_discharge {

/// DEM case of the slice with the prong driven at `drive` (fraction of the amplitude) during `on`. Counters: 0 "lip" (leaves the hopper's opening), 1
/// "belt" (landing, removed).
dem::Case make_case(const Config& c, const LineBasics& basics, std::string_view name, double drive, const std::vector<PulseWindow>& on,
                    double duration_s);
inline constexpr double kLevelTime_s = 0.45;  ///< how long each further drive level runs
std::vector<PulseWindow> pulse_train(const Config& c, const LineBasics& basics);
double train_duration(const Config& c, const std::vector<PulseWindow>& train);

Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& checkpoint_folder, Context& context);
}  // namespace venato::line::piezo_discharge
