#pragma once
#include "sync/registration/image_ops.h"
namespace venato::sync {

/// What is compared. `signed_evidence`: high where the vein is (fraction) or band-passed lightness (picture). `gradient`: edge strength divided
/// by its local mean, blind to polarity and to slow fading, on a grid edge_factor() times coarser.
struct Features {
  Feature signed_evidence, gradient;
  double contrast = 0;   ///< standard deviation of signed_evidence before normalisation: fraction, or L*/100
  double isotropy = 0;   ///< weak / strong eigenvalue of the summed structure tensor, 0..1; 0 = everything runs one way
  Point weak_direction;  ///< unit vector along which the picture does not change
};
/// \param base        evidence on the working grid (resample())
/// \param as_picture  band-pass instead of the plain fraction; must be the same for both sides
/// \param grain_m     Gaussian that removes granule noise, wanted_smoothing_m() of the noisier side; must be the same for both sides
/// Source: registration_print.md 1.3 step 0: DoG(2.5 mm, 40 mm); |grad G(2 mm)| over its 30 mm local mean, clipped at 4.
Features make_features(const Feature& base, bool as_picture, double grain_m, int threads);
/// How many pixels of the working grid make one pixel of Features::gradient (2 mm).
int edge_factor(double pitch_m);
/// The band-passed picture alone, its background taken from the pixels of `footprint` (0/255) only. Once the pose is known, the slab's footprint
/// gives print and slab the same background at the slab's rim; else the rim is off by up to a millimetre.
Feature band_pass(const Feature& base, double grain_m, const graphics::Raster8& footprint, int threads);
/// Smallest smoothing, 1 to 3 mm, that brings white pixel noise below an eighth of the picture's contrast.
/// Source of the noise estimate: J. Immerkaer, Comput. Vis. Image Underst. 64 (1996) 300, with the median in place of the mean.
double wanted_smoothing_m(const Feature& base, int threads);
}  // namespace venato::sync
