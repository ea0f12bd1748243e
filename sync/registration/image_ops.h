#pragma once
#include "graphics/raster/raster.h"
#include "sync/registration/registration.h"
namespace venato::sync {

/// One-channel raster with its validity; value is 0 wherever valid is 0, so that sums over value * mask need no branch.
struct Feature {
  graphics::RasterF value;
  graphics::Raster8 valid;  ///< 0 or 255, same size
};

/// Evidence on a grid of `pitch_m`, same origin: area average down (never point sampling: print data is dithered), Catmull-Rom up.
/// NaN and infinite pixels count as invalid; a pixel is valid if more than half of its area is.
Feature resample(const Evidence& evidence, double pitch_m, int threads);
/// Area average over factor x factor pixels; the right and bottom rim average what is there.
Feature downsample(const Feature& f, int factor, int threads);
/// Normalised (masked) Gaussian smoothing; sigma_px beyond 8 is done on a reduced grid. Valid where f is.
Feature smooth(const Feature& f, double sigma_px, int threads);
/// The same, but also valid outside of f's valid pixels as far as they still carry 5 % of the weight.
Feature smooth_and_extend(const Feature& f, double sigma_px, int threads);
/// Takes a rim of `radius_px` off the valid area, also along the picture's border: what a one-sided Gaussian has touched.
Feature without_rim(Feature f, int radius_px);
/// Mean and standard deviation over valid pixels (0, 0 if there are none).
struct Moments {
  double mean = 0, deviation = 0;
  double count = 0;
};
Moments moments(const Feature& f, int threads);
/// NCC over the pixels valid on both sides; 0 where one side is flat. \pre same size
double masked_ncc(const Feature& a, const Feature& b, int threads);
/// f(print_from_green(p)) on a width x height grid of f's own pitch in the green frame, Catmull-Rom in float
/// (not cv::remap: it rounds positions to 1/32 px). Invalid where the 2 x 2 neighbourhood is not valid.
Feature warp_to_green(const Feature& print, const Transform& print_from_green, int width, int height, int threads);
}  // namespace venato::sync
