#include <algorithm>
#include <cctype>
#include <utility>

#include "base/error.h"
#include "graphics/icc/separate_by_profile.h"
#include "graphics/tiff/ink_picture.h"
#include "line/chain/cut_to_slab.h"
#include "line/chain/pictures.h"
namespace venato::line {
namespace {
using graphics::Raster8;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}
std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

Raster8 in_order(const Raster8& source, const std::vector<int>& channels) {
  Raster8 out(source.width, source.height, static_cast<int>(channels.size()), source.pitch_m);
  const std::size_t n = channels.size(), pixels = out.data.size() / n;
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t k = 0; k < n; ++k) out.data[p * n + k] = source.data[p * n + static_cast<std::size_t>(channels[k])];
  return out;
}

/// A separated TIFF: the inks as they are; its look from the profile or the solids.
graphics::Graphic seen_inks(Raster8 ink, const LineConfig& c, const GraphicInks& inks, int threads) {
  if (inks.by_profile) return graphics::see_by_profile(ink, c.graphic.profile, threads);
  graphics::Graphic g;
  g.inks = inks.inks;
  g.body_srgb = inks.body_srgb;
  g.srgb = graphics::predict_srgb(g.inks, g.body_srgb, ink);
  g.ink = std::move(ink);
  return g;
}
}  // namespace

GraphicInks graphic_inks(const LineConfig& c) {
  const auto& g = c.graphic;
  if (g.profile.empty()) return {g.inks, g.body_colour, false};
  auto from_profile = graphics::read_profile_inks(g.profile);
  return {std::move(from_profile.inks), from_profile.body_srgb, true};
}

std::vector<int> ink_channels(const std::filesystem::path& file, const graphics::InkPictureInfo& info, const GraphicInks& printer) {
  const std::size_t n = printer.inks.size();
  std::vector<std::string> wanted;
  for (const auto& ink : printer.inks) wanted.push_back(ink.name);
  if (static_cast<std::size_t>(info.inks) != n)
    throw UsageError(file.string() + ": has " + std::to_string(info.inks) + " inks" + (info.names.empty() ? "" : " (" + joined(info.names) + ")") +
                     ", the printer has " + std::to_string(n) + " (" + joined(wanted) + ")");
  std::vector<int> channels(n);
  for (std::size_t k = 0; k < n; ++k) channels[k] = static_cast<int>(k);
  if (info.names.empty() || printer.by_profile) return channels;
  for (std::size_t k = 0; k < n; ++k) {
    const auto at = std::find_if(info.names.begin(), info.names.end(), [&](const auto& name) { return lower(name) == lower(wanted[k]); });
    const auto taken = channels.begin() + static_cast<std::ptrdiff_t>(k);
    if (at == info.names.end() || std::find(channels.begin(), taken, static_cast<int>(at - info.names.begin())) != taken)
      throw UsageError(file.string() + ": has the inks " + joined(info.names) + ", the printer has " + joined(wanted) +
                       "; call them by the same names in graphic/inks, each once");
    channels[k] = static_cast<int>(at - info.names.begin());
  }
  return channels;
}

std::vector<LoadedLayer> load_graphic(const LineConfig& c, int threads) {
  const auto& g = c.graphic;
  const auto placement = placement_transform(c);
  const GraphicInks inks = graphic_inks(c);
  std::vector<LoadedLayer> layers;
  for (const auto& layer : g.layers) {
    LoadedLayer out;
    out.name = layer.image.stem().string();
    out.warp = layer.warp;
    // A layer that does not follow the veins does not take part in the trial move either: it belongs to the slab, not to the pattern.
    const auto cut = [&](const Raster8& source, int channels) {
      return cut_to_slab(source, g.pitch_m, g.origin_x_m, g.origin_y_m, c.basics.fired_width_m, c.basics.fired_length_m, c.basics.print_from_design(),
                         layer.warp ? placement : sync::Transform{}, channels);
    };
    out.own_inks = graphics::is_separated_tiff(layer.image);
    if (out.own_inks) {
      const auto channels = ink_channels(layer.image, graphics::read_ink_picture_info(layer.image), inks);
      out.inks = seen_inks(cut(in_order(graphics::read_ink_picture(layer.image), channels), static_cast<int>(channels.size())), c, inks, threads);
      out.picture = out.inks.srgb;
    } else {
      out.picture = cut(graphics::load_picture(layer.image, g.pitch_m).pixels, 3);
      out.inks = inks.by_profile ? graphics::separate_by_profile(out.picture, g.profile, g.profile_intent, threads)
                                 : graphics::separate(out.picture, g.inks, g.body_colour, g.total_ink_limit);
    }
    layers.push_back(std::move(out));
  }
  return layers;
}
}  // namespace venato::line
