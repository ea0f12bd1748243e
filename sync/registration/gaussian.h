#pragma once
#include <span>
#include <vector>
namespace venato::sync {

/// Separable Gaussian of a width x height picture, zeros outside of it (outside carries no weight). Kernel cut at 3.5 sigma, sums of the kernel 1.
/// The same bytes for any number of threads. \pre sigma_px > 0, data.size() == width * height
/// \param out  the same size, not `data` itself
void gaussian(std::span<const float> data, int width, int height, double sigma_px, int threads, std::span<float> out);
/// What gaussian() makes of a line of n ones: how much of the kernel lies inside.
std::vector<float> gaussian_inside(int n, double sigma_px);
}  // namespace venato::sync
