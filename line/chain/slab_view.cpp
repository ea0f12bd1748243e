#include "line/chain/slab_view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "line/chain/exact_map.h"
#include "line/press_map/sample_slab.h"
namespace venato::line {
SlabSize green_size(const LineBasics& b) { return {b.fired_width_m * b.green_from_design(), b.fired_length_m * b.green_from_design()}; }

double zeta_at_depth(double depth_m, double thickness_m) { return thickness_m > 0 ? std::clamp(1 - depth_m / thickness_m, 0.0, 1.0) : 1.0; }

graphics::VeinMap look_at_slab(const LineBasics& b, const Slab& slab, double depth_m, int threads) {
  graphics::VeinMap map;
  for (const auto& p : b.powders) map.powders.push_back(p.name), map.colours.push_back(p.colour);
  map.body_powder = b.body_powder;
  map.depth_m = depth_m;
  map.fraction = sample_layer_fraction(slab, depth_m, -1, threads);
  return map;
}

graphics::RasterF vein_standard_error(const LineConfig& config, const std::vector<Operator>& operators, const FeedCommands& commands,
                                      const JitterField& jitter, Context& context) {
  int replicates = config.basics.bootstrap_replicates;
  bool any = false;
  for (const auto& op : operators)
    if (!op.replicates.empty()) replicates = std::min(replicates, static_cast<int>(op.replicates.size())), any = true;
  if (!any || replicates < 2) return {};
  const auto basics = coarse_basics(config, config.vein_map.coarse_pitch_m);
  std::vector<double> mean, spread;
  graphics::RasterF out;
  context.progress.begin("error bars", replicates, "replicates");
  for (int r = 0; r < replicates; ++r) {
    ApplyOptions options;
    options.replicate = r;
    const auto chain = apply_chain(config, basics, operators, commands, jitter, options, context);
    const auto vein = graphics::vein_fraction(look_at_slab(basics, *chain.state.slab, config.vein_map.polish_depth_m, context.threads));
    if (r == 0) out = vein, mean.assign(vein.data.size(), 0), spread.assign(vein.data.size(), 0);
    for (std::size_t k = 0; k < mean.size(); ++k) {  // Welford
      const double v = static_cast<double>(vein.data[k]), d = v - mean[k];
      mean[k] += d / (r + 1);
      spread[k] += d * (v - mean[k]);
    }
    context.progress.at(r + 1);
  }
  context.progress.end();
  for (std::size_t k = 0; k < mean.size(); ++k) out.data[k] = static_cast<float>(std::sqrt(spread[k] / (replicates - 1)));
  return out;
}

graphics::RasterF resample_to(const graphics::RasterF& raster, int width, int height, double pitch_m) {
  graphics::RasterF out(width, height, raster.channels, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int c = 0; c < raster.channels; ++c)
        out.at(i, j, c) = static_cast<float>(sample_bilinear(raster, (i + 0.5) * pitch_m, (j + 0.5) * pitch_m, c));
  return out;
}

double top_bottom_offset(const LineBasics& b, const Slab& slab, int threads) {
  const double thickness = static_cast<double>(*std::min_element(slab.thickness_m.data.begin(), slab.thickness_m.data.end()));
  const auto top = graphics::vein_fraction(look_at_slab(b, slab, 0, threads)),
             bottom = graphics::vein_fraction(look_at_slab(b, slab, thickness, threads));
  const double pitch_m = top.pitch_m;
  const int reach = static_cast<int>(0.15 / pitch_m);  // 150 mm: bottom extraction from a bin shears a bed by several times its height
  double best = -1, best_shift = kUnset;
  for (int s = -reach; s <= reach; ++s) {
    double cross = 0, a = 0, c = 0;
    for (int j = std::max(0, -s); j < std::min(top.height, top.height - s); ++j)
      for (int i = 0; i < top.width; ++i) {
        const double t = static_cast<double>(top.at(i, j)), u = static_cast<double>(bottom.at(i, j + s));
        cross += t * u, a += t * t, c += u * u;
      }
    const double score = a > 0 && c > 0 ? cross / std::sqrt(a * c) : -1;
    if (score > best) best = score, best_shift = s * pitch_m;
  }
  return best > 0 && std::abs(best_shift) < reach * pitch_m ? best_shift : kUnset;
}
}  // namespace venato::line
