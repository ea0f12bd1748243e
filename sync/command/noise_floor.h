#pragma once
#include <optional>
#include "sync/command/inputs.h"
#include "sync/registration/registration.h"
#include "sync/score/score.h"
namespace venato::sync {

/// What the method could reach on this very slab if print and body veins had the same shape: the slab's own evidence is bent by a random smooth map
/// (the found pose, displacements as large as those found, correlation 120 mm), cut to the graphic's frame, registered back by the same method with
/// the same settings, and scored against the body. It holds the method's error, the raster's resolution and what this vein pattern leaves
/// unobservable; it does not hold differences of shape between print and body (mixing, widths, veins that are missing on one side), which no warp can
/// remove. \return nothing when even that registration fails
std::optional<Metrics> noise_floor(const EvidencePair& evidence, const graphics::RasterF& body_fraction, const Registration& found,
                                   const RegistrationConfig& config, const ScoreConfig& score, Context& context);
inline constexpr const char* kNoiseFloorDefinition =
    "floor of the method on this slab: the slab's own vein picture, bent by a known-size random smooth map like the one found, registered back by "
    "the same "
    "method and scored against the body; contains method and raster error and directions this pattern leaves unobservable, not differences of shape "
    "between "
    "print and body, which no warp can remove";
}  // namespace venato::sync
