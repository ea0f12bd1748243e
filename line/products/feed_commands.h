#pragma once
#include <string>
#include <vector>
namespace venato::line {

/// What the dosing heads are told. duty[tick][prong] in 0..1 (0/1 when on/off). Prong p covers x in [p, p+1) * pitch; tick k the belt length [k, k+1)
/// * belt_speed * tick counted from the start of the lead-in.
struct FeedHead {
  std::string name;  ///< file name part, e.g. "vein_grey"
  std::string powder;
  int prongs = 0, ticks = 0;
  double prong_pitch_m = 0, tick_s = 0, belt_speed_m_s = 0;
  double full_rate_kg_m2 = 0;  ///< areal mass laid at duty 1
  std::vector<double> duty;    ///< [tick][prong]
  double mass_kg() const;      ///< sum of duty * rate * cell area
};
struct FeedCommands {
  std::vector<FeedHead> heads;
};
}  // namespace venato::line
