#include "line/chain/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
namespace venato::line {
namespace {
using graphics::Raster8;

/// Part of a picture that the slab covers, resampled to `pitch_out_m` = the picture's own pitch times a scale. Content is moved by `placement` (print
/// frame of the output). Bilinear; what lies outside the picture takes the colour of its border.
Raster8 cut_to_slab(const Raster8& source, double source_pitch_m, double origin_x_m, double origin_y_m, double width_m, double height_m,
                    double out_from_source, const sync::Transform& placement) {
  const int width = std::max(1, static_cast<int>(std::lround(width_m / source_pitch_m))),
            height = std::max(1, static_cast<int>(std::lround(height_m / source_pitch_m)));
  Raster8 out(width, height, 3, source_pitch_m * out_from_source);
  const Eigen::Matrix2d back = placement.a.transpose();  // a rotation
  const auto value = [&](int i, int j, int c) {
    i = std::clamp(i, 0, source.width - 1);
    j = std::clamp(j, 0, source.height - 1);
    return static_cast<double>(source.at(i, j, source.channels == 3 ? c : 0));
  };
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const sync::Point p((i + 0.5) * out.pitch_m, (j + 0.5) * out.pitch_m);
      const sync::Point content = back * (p - placement.t) / out_from_source;
      const double x = (content.x() + origin_x_m) / source_pitch_m - 0.5, y = (content.y() + origin_y_m) / source_pitch_m - 0.5;
      // Positions that are whole pixels but for rounding are copied exactly.
      const int i0 = static_cast<int>(std::floor(x + 1e-6)), j0 = static_cast<int>(std::floor(y + 1e-6));
      const double fx = std::max(0.0, x - i0), fy = std::max(0.0, y - j0);
      for (int c = 0; c < 3; ++c) {
        const double top = value(i0, j0, c) * (1 - fx) + value(i0 + 1, j0, c) * fx,
                     bottom = value(i0, j0 + 1, c) * (1 - fx) + value(i0 + 1, j0 + 1, c) * fx;
        out.at(i, j, c) = static_cast<std::uint8_t>(std::lround(top * (1 - fy) + bottom * fy));
      }
    }
  return out;
}

std::string mm(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%g mm", std::round(metres * 1e6) / 1e3);
  return text;
}

/// Issues of one picture: unreadable, or the slab reaches beyond it (half a pixel of rounding allowed).
void check_one(const std::string& pointer, const std::filesystem::path& file, double pitch_m, double origin_x_m, double origin_y_m,
               const LineBasics& b, std::vector<ConfigIssue>& issues) {
  try {
    const auto picture = graphics::load_picture(file, pitch_m);
    const double width = picture.pixels.width * pitch_m, height = picture.pixels.height * pitch_m;
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
  return cut_to_slab(picture.pixels, d.pitch_m, d.origin_x_m, d.origin_y_m, c.basics.fired_width_m, c.basics.fired_length_m, 1.0, sync::Transform{});
}

std::vector<LoadedLayer> load_graphic(const LineConfig& c) {
  const auto& g = c.graphic;
  const auto placement = placement_transform(c);
  std::vector<LoadedLayer> layers;
  for (const auto& layer : g.layers) {
    const auto picture = graphics::load_picture(layer.image, g.pitch_m);
    LoadedLayer out;
    out.name = layer.image.stem().string();
    out.warp = layer.warp;
    // A layer that does not follow the veins does not take part in the trial move either: it belongs to the slab, not to the pattern.
    out.picture = cut_to_slab(picture.pixels, g.pitch_m, g.origin_x_m, g.origin_y_m, c.basics.fired_width_m, c.basics.fired_length_m,
                              c.basics.print_from_design(), layer.warp ? placement : sync::Transform{});
    out.inks = graphics::separate(out.picture, g.inks, g.body_colour, g.total_ink_limit);
    layers.push_back(std::move(out));
  }
  return layers;
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
  check_one("/design/image", c.design.image, c.design.pitch_m, c.design.origin_x_m, c.design.origin_y_m, c.basics, issues);
  const auto& g = c.graphic;
  for (std::size_t k = 0; k < g.layers.size(); ++k) {
    check_one(g.single_image ? "/graphic/image" : "/graphic/layers/" + std::to_string(k) + "/image", g.layers[k].image, g.pitch_m, g.origin_x_m,
              g.origin_y_m, c.basics, issues);
  }
  return issues;
}
}  // namespace venato::line
