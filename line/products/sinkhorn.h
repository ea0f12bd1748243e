#pragma once
#include <string>
#include <vector>
namespace venato::line {

/// Scales the rows and columns of the layer-to-layer masses until every row and column sums to 1 (equal mass layers stay equal; multiscale.md
/// eq. 2.2), and the kernels of each pair with them. \param pair_mass [zin][zout], rows sum to 1; \param weight nz * nz kernels one after the other,
/// scaled in place. \return the largest relative change of a pair's mass. Gate: < 2 %, else the window is not stationary or the tracers too few.
/// \throws WorkError when no such scaling exists (e.g. nothing arrives in a layer) or 10^5 rounds do not reach 1e-12.
/// Source: Sinkhorn & Knopp, Pacific J. Math. 21 (1967) 343.
double balance_layers(const std::string& stage, int nz, const std::vector<double>& pair_mass, std::vector<double>& weight);
}  // namespace venato::line
