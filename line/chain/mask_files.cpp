#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "line/chain/run_line.h"
namespace venato::line {
namespace {

sync::FeedFile feed_file(const FeedHead& h) {
  return {h.name, h.powder, h.prongs, h.ticks, h.prong_pitch_m, h.tick_s, h.belt_speed_m_s, h.full_rate_kg_m2, h.duty};
}

sync::PowderMask powder_mask(const graphics::VeinMap& map, int powder, double scale) {
  sync::PowderMask mask;
  mask.name = map.powders[static_cast<std::size_t>(powder)];
  mask.fraction = graphics::RasterF(map.fraction.width, map.fraction.height, 1, map.fraction.pitch_m * scale);
  for (int j = 0; j < map.fraction.height; ++j)
    for (int i = 0; i < map.fraction.width; ++i) mask.fraction.at(i, j) = map.fraction.at(i, j, powder);
  return mask;
}

sync::MaskProfile mask_profile(const LineConfig& c, const std::vector<LoadedLayer>& layers) {
  sync::MaskProfile out;
  out.file = c.graphic.profile;
  out.bytes = read_file(out.file);
  out.sha256 = sha256_hex(out.bytes);
  out.intent = graphics::intent_name(c.graphic.profile_intent);
  out.use = graphic_use(c, layers).profile.value();
  return out;
}
}  // namespace

GraphicUse graphic_use(const LineConfig& c, const std::vector<LoadedLayer>& layers) {
  GraphicUse use;
  use.inks = layers.front().inks.inks;
  double pixels = 0, outside = 0;
  for (const auto& layer : layers) {
    use.layers_of_inks += layer.own_inks;
    use.layers_separated += !layer.own_inks;
    if (layer.own_inks || !layer.inks.profile) continue;
    const auto n = static_cast<double>(layer.picture.width) * layer.picture.height;
    pixels += n;
    outside += n * layer.inks.profile->out_of_gamut_share;
  }
  if (layers.front().inks.profile) {
    use.profile = graphics::ProfileUse{layers.front().inks.profile->description, outside / pixels};  // NaN when every layer has inks of its own
    use.intent = graphics::intent_name(c.graphic.profile_intent);
  }
  return use;
}

void write_mask_files(const std::filesystem::path& folder, const LineConfig& c, const LineRun& run, const std::vector<LoadedLayer>& layers,
                      const MaskChoices& choices, Context& context) {
  const auto& registration = run.sync.registration;
  // The printer sees the slab after drying: everything given in the green frame shrinks with it.
  const double dried = 1 - c.basics.drying_shrinkage;
  sync::MaskJob job;
  job.slab_id = c.title.empty() ? c.file.stem().string() : c.title;
  job.run_id = sha256_hex(c.resolved_json).substr(0, 16);
  job.inks = layers.front().inks.inks;
  job.body_srgb = layers.front().inks.body_srgb;
  if (!c.graphic.profile.empty()) job.profile = mask_profile(c, layers);
  for (const auto& layer : layers) {
    job.layers.push_back({layer.name, layer.inks.ink, layer.warp});
    job.separated_without_profile = job.separated_without_profile || layer.inks.separated_without_profile;
  }
  job.synchronised = registration.success;
  job.print_from_green = on_dried_slab(registration.success ? registration.print_from_green : run.sync.nominal, dried);
  // A layer that does not follow the veins belongs to the slab's outline: it stays where the design puts it.
  job.pose_from_green = on_dried_slab(run.sync.nominal, dried);
  const auto size = green_size(c.basics);
  job.width_m = size.width_m * dried;
  job.height_m = size.length_m * dried;
  job.dpi = c.graphic.print_dpi;
  job.compression = choices.compression;
  job.print_polarity = choices.print_polarity;
  job.ink_file_polarity = choices.ink_file_polarity;
  job.powders_at_print_resolution = choices.powders_at_print_resolution;
  for (int k = 0; k < static_cast<int>(run.vein_map.powders.size()); ++k) job.powders.push_back(powder_mask(run.vein_map, k, dried));
  for (const auto& h : run.chain.state.commands.heads) job.feeds.push_back(feed_file(h));
  sync::write_masks(job, folder, context);
}

void write_vein_map(const std::filesystem::path& file, const graphics::VeinMap& map, int threads) {
  graphics::TiffInfo info;
  info.width = map.fraction.width;
  info.height = map.fraction.height;
  info.channels = map.fraction.channels;
  info.kind = graphics::TiffKind::fractions_f32;
  info.dpi = 0.0254 / map.fraction.pitch_m;
  info.software = "venato";
  info.description = "share of each powder, channels:";
  for (const auto& p : map.powders) info.description += " " + p;
  graphics::write_tiff(file, map.fraction, info, threads);
}
}  // namespace venato::line
