#pragma once
/// S-CIELAB: colours as an eye at a distance sees them. Source: X. Zhang, B. A. Wandell, SID 96 Digest, 731, and J. SID 5 (1997) 61.
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// Light, light against dark, red against green, blue against yellow: what the eye blurs separately.
enum class EyeChannel { luminance, red_green, blue_yellow };
/// One opponent channel blurred as the eye at `distance_m` blurs it: sums of Gaussians (one of them negative for luminance) whose weights are
/// normalised to sum 1; spreads s in degrees of visual angle are those of exp(-r^2 / s^2): the standard deviation is s / sqrt 2.
/// \param channel one channel with its pitch \param distance_m > 0 \pre pitch_m > 0
RasterF eye_blur(const RasterF& channel, EyeChannel which, double distance_m, int threads);

/// CIE L*a*b* (three channels, D65) of a picture of XYZ (three channels, Y of the white = 1), as seen from `distance_m`; 0: as it is. A uniform
/// picture keeps its colour at any distance. Valid at pixels no coarser than the detail of interest: 1 mm is 3.4 arcmin at 1 m, an edge is then
/// placed by its pixels' values.
RasterF lab_seen_from(const RasterF& xyz, double distance_m, int threads);
/// CIEDE2000 pixel by pixel; one channel. Differences below 0.1, that nobody sees, are left as the Euclidean ones. \pre same size, three channels of
/// L*a*b*
RasterF delta_e2000(const RasterF& lab_a, const RasterF& lab_b, int threads);
}  // namespace venato::graphics
