#pragma once
namespace venato::graphics {
/// Output pixels that weighted_sum() sums side by side; each is one lane, so the width of the vector unit does not change a sum.
inline constexpr int kSumLanes = 32;
/// out[i] = sum over k < taps of w[k] rows[k][i], for i < n: the inner loop of separable filters, across and down. \pre n is a multiple of kSumLanes
void weighted_sum(const float* const* rows, const float* w, int taps, int n, float* out);
}  // namespace venato::graphics
