#pragma once
#include <vector>
#include "line/products/bed.h"
namespace venato::line {
/// s of (1 - length^2 lap) s = excess: zero slope at the side walls, periodic along the belt, five-point Laplacian, exact by cosine and Fourier
/// transforms. \param excess [ny][nx]; bits do not depend on `threads`
std::vector<double> even_out(const std::vector<double>& excess, const BedGrid& grid, double length_m, int threads);
}  // namespace venato::line
