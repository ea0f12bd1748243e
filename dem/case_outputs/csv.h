#pragma once
#include <string>
#include "dem/case_outputs/case_outputs.h"
namespace venato::dem {
/// Texts of the CSV files: one header line whose names end in their units, '.' decimals, nine digits.
std::string kpi_csv(const std::vector<Kpi>& kpis);
std::string table_csv(const RigTable& table);
std::string series_csv(const Case& c, const TimeSeries& s);
std::string counter_csv(const Case& c, const std::vector<CounterRecord>& records);
}  // namespace venato::dem
