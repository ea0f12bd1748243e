#pragma once
#include <optional>
#include <string>
#include <vector>
#include "base/context.h"
#include "graphics/raster/raster.h"
#include "sync/registration/phase_clock.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// One side of a registration: an evidence raster (1 channel) and where it is valid.
/// `vein_fraction`: the fraction of vein powder (0..1), same sign on both sides. `picture`: lightness L*/100 of any picture, polarity unknown.
enum class EvidenceKind { vein_fraction, picture };
struct Evidence {
  graphics::RasterF value;
  graphics::Raster8 valid;  ///< 255 = valid; empty = all
  EvidenceKind kind = EvidenceKind::vein_fraction;
};

struct RegistrationConfig {
  double max_rotation_rad = 0.0523598776;  ///< +-3 deg
  double rotation_step_rad = 0.0174532925;
  std::vector<double> scales = {0.99, 1.0, 1.01};
  bool allow_flip = false, allow_half_turn = false, allow_quarter_turns = false;
  double min_overlap = 0.35;
  double coarse_pitch_m = 0;            ///< 0 = 6 mm (4 mm for slabs under 1 m)
  double displacement_limit_m = 0.040;  ///< T5
};
struct Gate {
  std::string name;
  double value = 0, limit = 0;
  bool passed = false;
  std::string meaning;
};
struct ZoneConfidence {
  double x_m, y_m, width_m, height_m;
  int blocks;
  double residual_m, sigma_m;
  bool usable;
};
struct Registration {
  bool success = false;
  std::string reason;          ///< "" on success; else which gate failed with its number
  double confidence = 0;       ///< 0..1
  Transform print_from_green;  ///< not to be used when !success
  Transform pose_only;         ///< the affine part found before the non-rigid stage
  std::vector<Gate> gates;
  std::vector<ZoneConfidence> zones;  ///< 200 mm zones of the green frame; 90 % of errors below 1.52 sigma_m
  graphics::RasterF sigma_m;          ///< one channel, 10 mm pitch, predicted error
  double internal_residual_m = 0;
  SlabStretch stretch;        ///< of print_from_green's mean affine part over the slab; zeros when !success
  std::vector<Phase> phases;  ///< wall time of each step
};

/// Finds print_from_green from two evidence rasters (registration_print.md 1.3): exhaustive masked NCC for the pose, ECC affine for every surviving
/// candidate, block matching with 2x2 information matrices and a robust cubic B-spline, failure gates of 1.5.
/// Both sides are compared as fractions only if both are `vein_fraction`; else both are band-passed and either polarity is tried.
/// NaN and infinite pixels count as masked. Held-out residuals (T4) up to 0.8 mm pass where every other gate is sure: wide powder veins cannot do
/// better. \throws UsageError for a raster with no pitch, more than one channel or a mask of another size; Interrupted when context.stop is set. Same
/// bytes for any context.threads. Valid for displacements up to about 15 mm over 250 mm waves (25 mm: mostly found, tail of several mm). `prior`:
/// predicted map (regularise towards it), usually absent here. Never throws for pictures that do not belong together: success = false.
Registration register_veins(const Evidence& green, const Evidence& print, const RegistrationConfig& config, const std::optional<Transform>& prior,
                            Context& context);
}  // namespace venato::sync
