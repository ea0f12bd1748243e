#pragma once
#include <map>
#include <string>
#include <vector>
#include "base/context.h"
#include "line/chain/belt_jitter.h"
#include "line/chain/operators.h"
namespace venato::line {

struct StageRecord {
  std::string name;
  double mass_in_kg = 0, mass_out_kg = 0;
  double wall_s = 0;  ///< of apply
  std::map<std::string, double> kpi;
};
struct ChainResult {
  ChainState state;
  std::vector<StageRecord> stages;
  double commands_mass_kg = 0, slab_mass_kg = 0;
};

inline constexpr double kMassTolerance = 1e-6;  ///< relative; what issue and design ask of every stage's mass book
/// \throws WorkError naming stage and both masses when they differ by more than kMassTolerance, or are not finite.
void check_mass_book(const std::string& stage, double in_kg, double out_kg);

struct ApplyOptions {
  int replicate = -1;              ///< -1 best estimate, else bootstrap replicate
  bool log_stages = false;         ///< one line per stage border
  bool before_press_only = false;  ///< stop at the first stage that would make a slab
};
/// Applies all stages to the whole strip. The belt jitter moves the bed right before the stage that makes the slab.
ChainResult apply_chain(const LineConfig& config, const LineBasics& basics, const std::vector<Operator>& operators, const FeedCommands& commands,
                        const JitterField& jitter, const ApplyOptions& options, Context& context);

/// Line of the log: "press  1.82 s  mass in 1.2040 kg  out 1.2040 kg".
std::string stage_border_line(const StageRecord& record);
}  // namespace venato::line
