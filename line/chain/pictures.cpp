#include "line/chain/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "graphics/tiff/ink_picture.h"
#include "line/chain/cut_to_slab.h"
namespace venato::line {
namespace {
using graphics::Raster8;

std::string mm(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%g mm", std::round(metres * 1e6) / 1e3);
  return text;
}

/// \param inks  of the printer, for a file of ink amounts; nullptr for a picture
/// Issues of one picture: unreadable, other inks than the printer's, or the slab reaches beyond it (half a pixel of rounding allowed).
void check_one(const std::string& pointer, const std::filesystem::path& file, double pitch_m, double origin_x_m, double origin_y_m,
               const LineBasics& b, const GraphicInks* inks, std::vector<ConfigIssue>& issues) {
  try {
    double width = 0, height = 0;
    if (inks) {
      const auto info = graphics::read_ink_picture_info(file);
      width = static_cast<double>(info.width) * pitch_m, height = static_cast<double>(info.height) * pitch_m;
      ink_channels(file, info, *inks);
    } else {
      const auto picture = graphics::load_picture(file, pitch_m);
      width = picture.pixels.width * pitch_m, height = picture.pixels.height * pitch_m;
    }
    if (origin_x_m + b.fired_width_m > width + pitch_m / 2 || origin_y_m + b.fired_length_m > height + pitch_m / 2)
      issues.push_back({pointer,
                        file.string() + " is " + mm(width) + " x " + mm(height) + " at its pitch, but the slab with its origin reaches to " +
                            mm(origin_x_m + b.fired_width_m) + " x " + mm(origin_y_m + b.fired_length_m),
                        "check pitch_mm, origin_x_mm and origin_y_mm"});
  } catch (const UsageError& e) {
    issues.push_back({pointer, e.what(), ""});
  }
}
}  // namespace

sync::Transform placement_transform(const LineConfig& c) {
  sync::Transform t;
  const double angle = c.graphic.placement_rotation_rad, scale = c.basics.print_from_design();
  const sync::Point centre(c.basics.fired_width_m * scale / 2, c.basics.fired_length_m * scale / 2);
  t.a << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  t.t = centre - t.a * centre + sync::Point(c.graphic.placement_dx_m, c.graphic.placement_dy_m);
  return t;
}

Raster8 load_design(const LineConfig& c) {
  const auto& d = c.design;
  const auto picture = graphics::load_picture(d.image, d.pitch_m);
  return cut_to_slab(picture.pixels, d.pitch_m, d.origin_x_m, d.origin_y_m, c.basics.fired_width_m, c.basics.fired_length_m, 1.0, sync::Transform{},
                     3);
}

Raster8 flatten_layers(const std::vector<LoadedLayer>& layers, bool warped_only) {
  Raster8 out;
  for (const auto& layer : layers) {
    if (warped_only && !layer.warp) continue;
    if (out.empty()) {
      out = layer.picture;
      continue;
    }
    for (std::size_t k = 0; k < out.data.size(); ++k) out.data[k] = static_cast<std::uint8_t>((out.data[k] * layer.picture.data[k] + 127) / 255);
  }
  return out;
}

std::vector<ConfigIssue> check_pictures(const LineConfig& c) {
  std::vector<ConfigIssue> issues;
  check_one("/design/image", c.design.image, c.design.pitch_m, c.design.origin_x_m, c.design.origin_y_m, c.basics, nullptr, issues);
  const auto& g = c.graphic;
  GraphicInks inks;
  try {
    inks = graphic_inks(c);
  } catch (const UsageError& e) {
    issues.push_back({"/graphic/profile", e.what(), ""});
    return issues;
  }
  for (std::size_t k = 0; k < g.layers.size(); ++k) {
    check_one(g.single_image ? "/graphic/image" : "/graphic/layers/" + std::to_string(k) + "/image", g.layers[k].image, g.pitch_m, g.origin_x_m,
              g.origin_y_m, c.basics, graphics::is_separated_tiff(g.layers[k].image) ? &inks : nullptr, issues);
  }
  return issues;
}
}  // namespace venato::line
