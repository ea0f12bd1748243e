#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>
#include "base/plot/svg_plot.h"
#include "line/products/operator.h"
#include "sync/score/score.h"
namespace venato::line {

/// "mass_flow_kg_s" -> {"mass flow", "kg/s"}; the unit is the longest known one that the name ends in.
struct NamedUnit {
  std::string words, unit;
};
NamedUnit split_unit(const std::string& name);

/// One plot per unit in a curve's columns; x is the column of time, delay, position …: the first known abscissa, else the first column.
std::vector<Plot> plots_of_curve(const std::string& title, const std::map<std::string, std::vector<double>>& columns);
/// Kernel marginals of an operator: share of mass against delay and against sideways shift. Empty for kernels of a single cell.
std::vector<Plot> plots_of_kernel(const Operator& op);
/// Share of the matched centre line within a distance, before / after / best reachable.
Plot residual_plot(const std::vector<std::pair<std::string, std::vector<sync::ResidualSample>>>& sets);
}  // namespace venato::line
