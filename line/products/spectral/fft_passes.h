#pragma once
#include <cstddef>
/// Butterflies of BatchFft: one Stockham pass of radix p over m groups, x -> y:
/// y[p q + j] = w_q^j * sum_k x[q + m k] exp(-2 pi i j k / p), each index a run of `run` contiguous doubles (lanes and the stride of the passes
/// before).
namespace venato::line::fft {
struct PassShape {
  int m;
  std::size_t run;
  const double* twiddle;  ///< [m][p - 1][2]
};
void pass2(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi);
void pass3(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi);
void pass4(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi);
void pass5(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi);
void pass_any(int radix, const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi);
}  // namespace venato::line::fft
