#pragma once
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>
namespace venato::line {

/// What the report shows, read from a run folder: run.json and score.json. Numbers that the files give as null are NaN.
struct ReportMetrics {
  double median_mm, p95_mm, offset_mm, matched, f1_1, f1_2, f1_3, dice, missing_mm, extra_mm, missing_percent, extra_percent, max_mm, cl_dice,
      assd_mm, hd95_mm, area_percent, width_mm, direction;
  double visible_1m_percent;  ///< of the print's vein length, seen to be off from 1 m
};
struct ReportFigure {
  std::string file, section, title, caption;
};
struct ReportGate {
  std::string name, meaning;
  double value, limit;
  bool passed;
};
struct ReportStage {
  std::string name;
  double wall_s, mass_in_kg, mass_out_kg;
  bool cached;
  std::map<std::string, double> kpi, figures;
  std::vector<std::string> warnings;
};
struct ReportZone {
  std::string verdict;  ///< of sync::Verdict
  double x_mm, y_mm, width_mm, height_mm, median_mm, p95_mm, matched, found;
};
struct ReportVerdict {
  std::string slab;  ///< of sync::Verdict, or "not_registered"
  double good_median_mm, good_p95_mm, fair_p95_mm, least_matched;
  double median_low_mm, median_high_mm, p95_low_mm, p95_high_mm;  ///< 95 % intervals
};
struct ReportPlaceholder {
  std::string pointer, value, unit, help;
};
struct ReportData {
  std::string title, code_version, config_file, config_sha256, cpu, seed;
  int threads = 0;
  double peak_memory_gib = 0;
  std::vector<std::pair<std::string, std::string>> asked;  ///< label, value
  ReportMetrics before{}, after{}, best{};
  ReportVerdict verdict{};
  std::vector<ReportZone> zones;  ///< row by row
  bool registered = false;
  std::string reason;
  double confidence = 0, internal_residual_mm = 0, true_median_mm = 0, true_p95_mm = 0, top_bottom_mm = 0;
  double body_edge_mm = std::numeric_limits<double>::quiet_NaN(), print_edge_mm = body_edge_mm;  ///< 10-90 % edge width, median
  std::vector<ReportGate> gates;
  std::vector<ReportStage> stages;
  double feed_kg = 0, slab_kg = 0;
  std::vector<std::pair<std::string, double>> timing_s;
  std::vector<ReportPlaceholder> placeholders;
  std::vector<std::string> warnings;
  std::vector<ReportFigure> figures;
};
/// \throws UsageError naming file and key when the folder is not a finished run.
ReportData read_report_data(const std::filesystem::path& run_folder);
}  // namespace venato::line
