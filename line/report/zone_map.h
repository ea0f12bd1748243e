#pragma once
#include <string>
#include "line/report/report_data.h"
namespace venato::line {
/// Slab seen from above, feed direction upward as in the overlay (first row of pixels on top): every zone coloured by its verdict, with the P95 in mm,
/// and beside it the legend. Empty without zones.
std::string zone_map_html(const ReportData& d);
}  // namespace venato::line
