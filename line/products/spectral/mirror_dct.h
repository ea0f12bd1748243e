#pragma once
#include <vector>
#include "line/products/spectral/batch_fft.h"
namespace venato::line {

/// Cosine transform of signals between two mirrors (DCT-II): X_k = sum_i x_i cos(pi k (i + 1/2) / n). A convolution with a symmetric kernel h between
/// mirror walls is a product here: Y_k = X_k (h_0 + 2 sum_e h_e cos(pi k e / n)), exactly, for any width of h. Transforms 2 * kBatch real signals in
/// place: kBatch in re[n][kBatch], kBatch in im[n][kBatch]. Source: Makhoul, IEEE Trans. ASSP 28 (1980) 27: one complex FFT of length n.
class MirrorDct {
 public:
  explicit MirrorDct(int n);
  int size() const { return fft_.size(); }
  std::size_t work_size() const { return fft_.work_size() + 2 * static_cast<std::size_t>(size()) * BatchFft::kBatch; }
  void forward(double* re, double* im, double* work) const;
  void inverse(double* re, double* im, double* work) const;  ///< scaled: gives the input of forward back

 private:
  BatchFft fft_;
  std::vector<double> shift_;  // [k][2] = exp(-i pi k / 2n)
};
}  // namespace venato::line
