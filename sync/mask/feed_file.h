#pragma once
#include <filesystem>
#include <string>
#include <vector>
namespace venato::sync {

/// What one dosing head is told, as plain data. Prong p covers x in [p, p + 1) * prong_pitch_m; tick k lasts [k, k + 1) * tick_s.
struct FeedFile {
  std::string name;  ///< [A-Za-z0-9_-]{1,40}, part of the file name
  std::string powder;
  int prongs = 0, ticks = 0;
  double prong_pitch_m = 0, tick_s = 0, belt_speed_m_s = 0;
  double full_rate_kg_m2 = 0;  ///< areal mass laid at duty 1
  std::vector<double> duty;    ///< [tick][prong], 0..1
};

/// \throws UsageError when sizes and data do not agree, a duty is not in 0..1, or a pitch or time is not positive.
void check_feed(const FeedFile& feed);
/// Table: comment lines (#) with every quantity and unit, a header line, one row per tick: time_ms, then the duty of each prong.
std::string feed_csv_text(const FeedFile& feed);
/// Writes feed_<name>.csv and feed_<name>.tif (grey, 0 = off, 255 = full, one pixel per prong and tick, dpi of the prong pitch) into an existing
/// folder.
void write_feed(const FeedFile& feed, const std::filesystem::path& folder);
}  // namespace venato::sync
