#pragma once
#include <Eigen/Core>
#include <utility>
#include <vector>
namespace venato::sync {

/// Symmetric matrix whose entries vanish beyond `half_band` from the diagonal; the lower triangle is stored by rows. The normal equations of a
/// spline on a grid have that form, and a band needs no search for indices: 3-4 times faster here than a general sparse factorisation.
class BandMatrix {
 public:
  BandMatrix(int order, int half_band);
  int order() const { return order_; }
  int half_band() const { return half_band_; }
  double& at(int i, int j) { return row(i)[j]; }  ///< \pre i - half_band <= j <= i
  double at(int i, int j) const { return row(i)[j]; }
  /// Row i such that row(i)[j] is entry (i, j).
  double* row(int i) { return data_.data() + static_cast<std::ptrdiff_t>(i) * stride_ + (kPad + half_band_ - i); }
  const double* row(int i) const { return data_.data() + static_cast<std::ptrdiff_t>(i) * stride_ + (kPad + half_band_ - i); }
  static constexpr int kPad = 3;  ///< zeros before the band of each row: four neighbouring rows can be read over one range

 private:
  int order_, half_band_, stride_;
  std::vector<double> data_;
};

/// Cholesky factor A = L L^T of a band matrix; L has the same band. Sums in a fixed order: the same bytes on every machine.
class BandCholesky {
 public:
  /// \throws WorkError if a is not positive definite
  explicit BandCholesky(BandMatrix a);
  /// The storage, to be filled again: a new one of 10 MB costs as much as a tenth of the factorisation.
  BandMatrix release() && { return std::move(l_); }
  Eigen::VectorXd solve(Eigen::VectorXd right) const;
  const BandMatrix& lower() const { return l_; }

 private:
  BandMatrix l_;
};
/// Entries of A^-1 inside the band, by Takahashi's recursion. Source: Takahashi, Fagan & Chen 1973; Erisman & Tinney, Comm. ACM 18 (1975) 177.
class BandInverse {
 public:
  explicit BandInverse(const BandCholesky& factor);
  /// (A^-1)(i, j). \pre |i - j| <= half_band
  double at(int i, int j) const { return row(i)[j]; }

 private:
  double* row(int i) { return data_.data() + static_cast<std::ptrdiff_t>(i) * stride_ + (half_band_ - i); }
  const double* row(int i) const { return data_.data() + static_cast<std::ptrdiff_t>(i) * stride_ + (half_band_ - i); }
  int half_band_, stride_;
  std::vector<double> data_;  ///< both triangles
};
}  // namespace venato::sync
