#pragma once
/// Simple colour model of inks on a body, used only when there is no printer profile. Internal to separate / predict_srgb.
///   ln R(c) = ln R_body(c) + sum_k a_k * (ln R_solid_k(c) - ln R_body(c)),   c = linear R, G, B;  a_k in [0, 1]
/// Beer-Lambert-like: every ink's 100 % patch on the bare body and the bare body itself come out exactly.
/// Source: registration_print notes 6.3 (own model); it ignores dot gain, trapping and firing reactions: a preview.
#include <array>
#include <vector>
#include "graphics/colour/srgb.h"
#include "graphics/graphic.h"
namespace venato::graphics {

using Log3 = std::array<double, 3>;
/// Linear reflectance floor: sRGB 5 of 255. Fired ceramic does not get darker, and the logarithm needs one.
inline constexpr double kReflectanceFloor = 0.0015;

struct InkModel {
  Log3 body{};               ///< ln R of the body
  std::vector<Log3> absorb;  ///< ln R_solid - ln R_body per ink at 100 %
};
InkModel make_ink_model(const std::vector<Ink>& inks, const Srgb8& body);
double log_reflectance(std::uint8_t srgb);
/// ln R of the mixture. \param amounts [0, 1], one per ink
Log3 mix_log_reflectance(const InkModel& model, const double* amounts);

/// Bounded least squares: minimises |sum a_k absorb_k - target|^2 + kSparsity * sum a_k over a in [0, 1], sum a <= limit, at most `most`
/// (1 to 3) inks non-zero. All subsets and all faces of the box are tried, which is exact for so few unknowns and always gives the same bits.
/// \param target ln R - ln R_body \param allowed inks that may be used \return amounts, one per ink
std::vector<double> solve_inks(const InkModel& model, const Log3& target, double limit, int most, const std::vector<int>& allowed);
}  // namespace venato::graphics
