#pragma once
/// A sum whose bytes do not depend on the order of its terms. Every term is rounded to a coarse and a fine grid; sums of multiples of one quantum are
/// exact in double precision, so order, blocks and threads do not matter. Validity: terms up to 2e6 (N or N m), sums up to 8e6; of terms below half a
/// coarse quantum about 60,000 with equal signs, far more with mixed ones. Resolution 3e-21. Outside of that the sum is still right to rounding, but
/// no longer independent of the order.
namespace venato::dem {

class ExactSum {
 public:
  void add(double x) {
    const double coarse = (x + kCoarse) - kCoarse;
    coarse_ += coarse;
    fine_ += ((x - coarse) + kFine) - kFine;
  }
  void add(const ExactSum& o) { coarse_ += o.coarse_, fine_ += o.fine_; }
  double value() const { return coarse_ + fine_; }

 private:
  // 1.5 * 2^52 quanta: adding and taking away rounds to a multiple of the quantum (2^-30 and 2^-68).
  static constexpr double kCoarse = 0x1.8p+22, kFine = 0x1.8p-16;
  double coarse_ = 0, fine_ = 0;
};
}  // namespace venato::dem
