#pragma once
#include <cstddef>
namespace venato::line {
/// Spectra of two real kernels packed as one complex signal g = h1 + i h2, all [n][8] split complex.
struct ConstSpectrum {
  const double *re, *im;
};
struct Spectrum {
  double *re, *im;
};
/// out1 += h1 * in, out2 += h2 * in for all n frequencies (out2.re null: only the first).
void add_products(int n, ConstSpectrum packed, ConstSpectrum in, Spectrum out1, Spectrum out2);
/// inout *= h1 where h1 is the spectrum of one real kernel.
void multiply(int n, ConstSpectrum kernel, Spectrum inout);
/// row[b] += sum over e of weight[e] * cosine[e][b], for the 8 lanes.
void cosine_sum(int n_e, const double* weight, const double* cosine, double* row);
}  // namespace venato::line
