#pragma once
/// What a bench rig is to a case. A rig is a folder dem/rigs/<name>/ with rig.h that defines
///   namespace venato::dem::rigs::<name> { RigDescriptor descriptor(); }
/// The build finds the folder (CMake venato_collect) and lists it; nothing else is edited to add one. A case asks for it by
/// "rig": { "kind": "<name>", … }: the run stays an ordinary DEM run, the rig turns its result into numbers with error bars and plots.
#include <functional>
#include <string>
#include <string_view>
#include <vector>
#include "base/config/object_reader.h"
#include "base/plot/svg_plot.h"
#include "dem/case.h"
#include "dem/kpi.h"
#include "dem/run_case.h"

namespace venato::dem {

struct RigPlot {
  std::string name;  ///< of the file, without .svg
  Plot plot;
};
/// Numbers behind a plot: <name>.csv and /rig/<name>/<column> in result.h5.
struct RigTable {
  std::string name;
  struct Column {
    std::string name, unit, description;  ///< the name ends in the unit
    std::vector<double> values;           ///< all columns are equally long; NaN = none
  };
  std::vector<Column> columns;
};
struct RigResult {
  std::vector<Kpi> kpis;
  std::vector<RigPlot> plots;
  std::vector<RigTable> tables;
  std::vector<std::string> warnings;  ///< why a number is missing or should not be trusted
};

/// A configured rig: its closure holds its own config by value.
struct Rig {
  std::string kind;
  /// Pure function of case and result. What cannot be measured (nothing flowed, too few grains) is NaN with a warning, never a guess.
  std::function<RigResult(const Case&, const CaseResult&)> measure;
};
struct RigDescriptor {
  std::string_view name, help;
  /// Declares and reads the rig's keys; may add to the case what the measurement needs (snapshot plans, smallest opening). Called last, when the
  /// rest of the case is known.
  std::function<Rig(ObjectReader&, Case&)> read;
};
/// All rigs found by the build, sorted by name.
const std::vector<RigDescriptor>& all_rigs();
/// "rig": optional object, picked by its "kind".
void read_rig(ObjectReader& r, Case& c);
}  // namespace venato::dem
