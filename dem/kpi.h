#pragma once
#include <limits>
#include <string>
namespace venato::dem {

/// One measured number of a case or of a bench rig: one line of kpi.csv, one entry of /kpi in result.h5.
struct Kpi {
  std::string name;  ///< ends in its unit where it has one
  double value = 0;
  double standard_error = std::numeric_limits<double>::quiet_NaN();  ///< NaN = not known (empty in the file)
  std::string unit = {}, description = {};
  std::string error_from = {};  ///< what the standard error was made from, e.g. "6 wedges"; empty = none
};
}  // namespace venato::dem
