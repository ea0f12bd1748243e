#pragma once
#include <filesystem>
#include <string>
#include <vector>
namespace venato::line::app {

/// What the command line said. Filled by CLI11 in parse.cpp.
struct Options {
  std::string command;
  std::filesystem::path input, out, vein_map, camera, graphic;
  std::vector<std::string> overrides;
  int threads = 0;  ///< 0 = all cores this process may use
  bool quiet = false, json_log = false, schema = false, dem = false;
  bool resume = false, restart = false, profile = false;                                                      ///< of a DEM case
  double until_s = 0;                                                                                         ///< of a DEM case; 0 = to its end
  double dpi = 0;                                                                                             ///< of masks; 0 = the run's
  std::string compression = "deflate", print_polarity = "zero-is-no-ink", ink_polarity = "zero-is-full-ink";  ///< of masks
  bool powders_at_print_resolution = false;
  double vein_pitch_mm = 0, graphic_pitch_mm = 0;  ///< 0 = from the file
  std::string turns = "none";                      ///< of sync: none, half or quarter
  bool mirrored = false;                           ///< of sync: the graphic may lie mirrored on the slab
  double max_rotation_deg = 3;                     ///< of sync
};
struct Parsed {
  Options options;
  bool finished = false;  ///< help or version was printed, or the usage was wrong: return exit_code
  int exit_code = 0;
};
Parsed parse(int argc, const char* const* argv);
}  // namespace venato::line::app
