#pragma once
#include <string>
#include <vector>
#include "line/products/operator.h"
namespace venato::line {

/// operator_from_landings of the first set, with the others as its bootstrap replicates on one grid wide enough for all (grids of one step size are
/// aligned: cells are centred at whole steps from each set's own reference delay). \throws WorkError as operator_from_landings.
Operator operator_with_replicates(const std::string& stage, const std::vector<std::vector<Landing>>& sets, int nz_in, int nz_out, double dtheta_s,
                                  double deta_m, bool full_bed);
}  // namespace venato::line
