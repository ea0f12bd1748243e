#pragma once
#include <array>
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// Which side of the body's lightness the veins lie on.
enum class VeinTone { darker, lighter };

/// How the picture becomes a plan of powders.
struct VeinPlanConfig {
  double background_window_m = 0.12;  ///< local background lightness is taken over this window
  double darkness_threshold = 0.10;   ///< vein where L*/100 is darker than the local background by more than this
  double min_width_m = 0.008;         ///< body veins are widened to this (a prong pitch of 5 mm cannot make a 3 mm vein)
  double min_area_m2 = 4e-4;          ///< smaller specks are left to the printer
  double smoothing_m = 0.002;         ///< Gaussian sigma, of the picture before the threshold and of the outline after it
  VeinTone tone = VeinTone::darker;   ///< lighter: white veins on a black body
};
/// Target powder fractions in the design frame. fraction: channels = powders, sum 1. Soft edges by area coverage.
struct VeinPlan {
  std::vector<std::string> powders;
  int body_powder = 0;
  RasterF fraction;
};
/// The body's veins are a widened, simplified version of the picture's: L* against the local background -> threshold -> every line brought to
/// min_width along its centre line, holes narrower than that filled -> outline smoothed -> parts smaller than min_area left out.
/// \param design_srgb 1 or 3 channels, any pitch; the plan is made at the largest whole multiple of that pitch up to 1 mm (at the picture's
///        own pitch when that is coarser)
/// \return channels in the order of `powders`, sum 1; powders other than the two named are 0
/// \throws UsageError when the picture has no pitch or a config value is not positive
VeinPlan plan_veins(const Raster8& design_srgb, const VeinPlanConfig& config, const std::vector<std::string>& powders, int body_powder,
                    int vein_powder);
}  // namespace venato::graphics
