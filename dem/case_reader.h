#pragma once
#include <filesystem>
#include "base/config/object_reader.h"
#include "dem/case.h"
namespace venato::dem {

/// Reads the file of `venato dem CASE.json` ("format": "venato-dem", "version": 1): every key is declared here or in the parts that this calls,
/// with its unit at the edge (mm, um, deg, Hz, g/s …) and SI inside. Mistakes are collected as issues, including the cross-checks: names that do
/// not exist or are used twice, missing material pairs, fractions that do not sum to 1, regions and counters outside the box, periodic
/// lengths below two of the largest grains, mesh files that are none. Example: configs/dem/slot_hopper.json.
void read_case(ObjectReader& r, Case& c);

/// read_config_file + read_case; `outcome` (may be null) gets issues, resolved config, placeholders.
/// \throws UsageError (file cannot be read), ConfigError (all issues at once).
Case load_case(const std::filesystem::path& file, const std::vector<Override>& overrides = {}, ReadOutcome* outcome = nullptr);
}  // namespace venato::dem
