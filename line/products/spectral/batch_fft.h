#pragma once
#include <vector>
namespace venato::line {

/// Complex FFT of kBatch signals at once, any length n >= 1. Data are split: re[n][kBatch], im[n][kBatch], so that every butterfly is a loop over
/// contiguous lanes that any CPU vectorises; the lanes never mix, so results do not depend on the instruction set or on what the other lanes hold.
/// Stockham autosort with radices 4, 2, 3, 5 and small primes; a prime factor above 50 goes through Bluestein's chirp (Bluestein 1970).
/// forward: X_k = sum_j x_j exp(-2 pi i jk / n); inverse: with +i, not scaled (n times the input comes back).
/// The plan is const after construction: threads share it and bring their own work arrays.
class BatchFft {
 public:
  static constexpr int kBatch = 8;
  explicit BatchFft(int n);
  int size() const { return n_; }
  std::size_t work_size() const;  ///< doubles that forward and inverse need
  void forward(double* re, double* im, double* work) const;
  void inverse(double* re, double* im, double* work) const { forward(im, re, work); }

 private:
  struct Stage {
    int radix, m, s;              // m = remaining length / radix, s = product of the radices before
    std::vector<double> twiddle;  // [q][radix - 1][2]: exp(-2 pi i q j / (m * radix)), j = 1 …
  };
  void smooth(double* re, double* im, double* work) const;
  void bluestein(double* re, double* im, double* work) const;

  int n_;
  std::vector<Stage> stages_;
  std::vector<double> chirp_;           // [n][2], empty unless Bluestein
  std::vector<double> chirp_spectrum_;  // [m][2]
  std::vector<BatchFft> inner_;         // 0 or 1 plan of length m
};

/// Smallest 2^a 3^b 5^c >= n.
int next_smooth_size(int n);
}  // namespace venato::line
