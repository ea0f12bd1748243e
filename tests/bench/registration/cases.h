#pragma once
/// Pairs of slab and graphic with a known smooth map between them, for tests/bench/registration_vs_peers.
#include <cstdint>
#include <string>
#include <vector>
#include "tests/sync/registration/synthetic.h"
namespace venato::bench {

/// One rendered scene: 1 px/mm, larger than any slab.
struct Scene {
  std::string name;
  graphics::RasterF luma;   ///< 0..1
  graphics::RasterF other;  ///< another mixture of the colour channels: the slab under other pigments
  graphics::RasterF plan;   ///< vein fraction
};
/// \param file  a name that contains "dark" has veins lighter than the body
Scene load_scene(const std::string& file);

struct PairSettings {
  std::string kind = "plain";  ///< row of the result table
  double amplitude_m = 0.010, missing = 0, faded = 0, blur_mm = 2, noise = 0.03;
  bool picture = false;   ///< lightness against lightness; else vein fractions
  bool inverted = false;  ///< picture: contrast turned round, other colours, uneven light, speckle
  bool portion = false;   ///< slab of 800 x 1600 mm from anywhere in the graphic; else the whole face, 1600 x 3200 mm
};
struct Pair {
  graphics::RasterF green, print;
  sync::EvidenceKind kind = sync::EvidenceKind::vein_fraction;
  sync::synthetic::Truth truth;  ///< print_from_green
  graphics::RasterF veins;       ///< vein fraction of the print frame
  double faded_from_m = 0, faded_to_m = 0;  ///< y of the faded strip
  graphics::RasterF kept;        ///< green frame: 1 where the vein was left, 0 where it was taken out; empty = all
};
Pair make_pair(const Scene& scene, const PairSettings& settings, std::uint64_t seed);
/// What a line's simulation would predict: the truth, but off by waves of 600 to 1200 mm whose largest length is error_m, its affine part off by 2 mm.
sync::Transform make_prior(const Pair& pair, double error_m, std::uint64_t seed);
/// The judged set: `count` settings in a fixed order of kinds.
std::vector<PairSettings> judged_settings(int count);
}  // namespace venato::bench
