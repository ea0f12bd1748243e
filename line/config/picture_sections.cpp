#include "line/config/sections.h"
namespace venato::line {
namespace {
constexpr std::size_t kMaxInks = 15;  // of an ICC profile

/// How the graphic gets its inks: the printer's profile, or the inks' solids (a preview, unless the graphic has inks of its own).
void read_inks(ObjectReader& r, GraphicConfig& g) {
  using graphics::RenderingIntent;
  r.path("profile", g.profile, PathKind::existing_file, {"ICC output profile of printer, inks and body; instead of `inks` and `body_colour`", ""});
  r.choice("profile_intent", g.profile_intent,
           {{"perceptual", RenderingIntent::perceptual},
            {"relative_colorimetric", RenderingIntent::relative_colorimetric},
            {"saturation", RenderingIntent::saturation},
            {"absolute_colorimetric", RenderingIntent::absolute_colorimetric}},
           {"of the profile: what happens to colours that the inks cannot make", "perceptual"});
  const bool by_profile = !g.profile.empty();
  if (r.describing() || r.has("inks"))
    r.objects("inks", "in the printer's order; instead of `profile`", r.describing() ? 0 : 1, kMaxInks, [&](ObjectReader& o, std::size_t) {
      graphics::Ink ink;
      Rgb8 solid{};
      o.name("name", ink.name, {"InkNames entry and file name part"});
      o.colour("solid", solid, {"sRGB of a fired 100 % patch on the body", {}, true});
      ink.solid_srgb = solid;
      if (!o.describing()) {
        for (const auto& other : g.inks)
          if (other.name == ink.name) o.issue("name", "two inks are called '" + ink.name + "'", "every ink needs its own name");
        g.inks.push_back(ink);
      }
    });
  r.colour("body_colour", g.body_colour, {.help = "sRGB of the fired body without print; needed with `inks`", .optional = true});
  if (r.describing()) return;
  if (by_profile && r.has("inks")) r.issue("inks", "has both a profile and inks; the profile has its own", "give exactly one of them");
  if (by_profile && r.has("body_colour")) r.issue("body_colour", "the profile tells the colour of the body", "remove body_colour");
  if (!by_profile && !r.has("inks"))
    r.issue("inks", "colours cannot become inks: neither a profile nor inks with their solids",
            "give `profile` (the printer's ICC output profile), or `inks` with name and solid = the sRGB of a fired 100 % patch of each, and "
            "`body_colour`");
  else if (!by_profile && !r.has("body_colour"))
    r.issue("body_colour", "is missing: the inks' solids are seen on it", "give the sRGB of the fired body without print");
}
}  // namespace

void read_design(ObjectReader& r, DesignConfig& d) {
  r.path("image", d.image, PathKind::existing_file, {"picture whose veins go through the body (PNG, JPEG, TIFF)"});
  r.number("pitch_mm", d.pitch_m, {0.02, 20, "mm"}, {"size of one pixel on the fired slab"});
  r.number("origin_x_mm", d.origin_x_m, {0, 10000, "mm"}, {"first corner of the slab inside the picture", 0.0});
  r.number("origin_y_mm", d.origin_y_m, {0, 10000, "mm"}, {"same, along the belt", 0.0});
  r.object(
      "plan", "how the picture becomes a plan of powders",
      [&](ObjectReader& o) {
        auto& p = d.plan;
        o.number("background_window_mm", p.background_window_m, {5, 1000, "mm"}, {"local background lightness is taken over this window", 120.0});
        o.number("darkness_threshold", p.darkness_threshold, {0.01, 0.9, "1"},
                 {"vein where L*/100 is darker than the local background by more than this", 0.10});
        o.choice("tone", p.tone, {{"darker", graphics::VeinTone::darker}, {"lighter", graphics::VeinTone::lighter}},
                 {"veins are darker or lighter than the body", "darker"});
        o.number("min_width_mm", p.min_width_m, {0, 100, "mm"}, {"body veins are widened to this: 1.5 to 2 prong pitches", 8.0});
        o.number("min_area_mm2", p.min_area_m2, {0, 1e6, "mm2"}, {"smaller specks are left to the printer", 400.0});
        o.number("smoothing_mm", p.smoothing_m, {0, 50, "mm"}, {"of the vein outline", 2.0});
      },
      false);
}

void read_graphic(ObjectReader& r, GraphicConfig& g) {
  std::filesystem::path image;
  r.path("image", image, PathKind::existing_file, {"the inkjet graphic: an RGB picture, or a separated TIFF of the inks; instead of `layers`", ""});
  std::vector<GraphicLayer> layers;
  if (r.describing() || r.has("layers")) {
    r.objects("layers", "the inkjet graphic as layers, multiplied in this order; instead of `image`", r.describing() ? 0 : 1, 16,
              [&](ObjectReader& o, std::size_t) {
                GraphicLayer layer;
                o.path("image", layer.image, PathKind::existing_file, {"picture of this layer, or its inks (separated TIFF)"});
                o.boolean("warp", layer.warp, {"true: moves with the veins; false: keeps its place on the print", true});
                layers.push_back(layer);
              });
  }
  if (!r.describing()) {
    if (r.has("image") == r.has("layers"))
      r.issue("", r.has("image") ? "has both image and layers" : "has neither image nor layers", "give exactly one of them");
    g.layers = layers.empty() ? std::vector<GraphicLayer>{{image, true}} : layers;
    g.single_image = layers.empty();
    bool moves = false;
    for (const auto& l : g.layers) moves = moves || l.warp;
    if (!moves) r.issue("layers", "no layer has warp = true: there would be nothing to synchronise", "set warp of the vein layer to true");
  }
  r.number("pitch_mm", g.pitch_m, {0.02, 20, "mm"}, {"size of one pixel on the fired slab"});
  r.number("origin_x_mm", g.origin_x_m, {0, 10000, "mm"}, {"first corner of the slab inside the picture", 0.0});
  r.number("origin_y_mm", g.origin_y_m, {0, 10000, "mm"}, {"same, along the belt", 0.0});
  read_inks(r, g);
  r.number("print_dpi", g.print_dpi, {25, 1200, "dpi", "print heads"}, {"of masks/print.tif", 360.0});
  r.number("total_ink_limit", g.total_ink_limit, {0.5, 8, "1"}, {"largest sum of ink fractions in a pixel", 2.4, true});
  r.object(
      "placement", "a known extra move of the graphic on the print, for trials",
      [&](ObjectReader& o) {
        o.number("dx_mm", g.placement_dx_m, {-200, 200, "mm"}, {"across", 0.0});
        o.number("dy_mm", g.placement_dy_m, {-200, 200, "mm"}, {"along", 0.0});
        o.number("rotation_deg", g.placement_rotation_rad, {-10, 10, "deg"}, {"about the centre of the slab", 0.0});
      },
      false);
}

void read_vein_map(ObjectReader& r, VeinMapConfig& v) {
  r.number("polish_depth_mm", v.polish_depth_m, {0, 20, "mm"}, {"what is taken off the pressed face before it is looked at", 0.0});
  r.number("coarse_pitch_mm", v.coarse_pitch_m, {0.5, 50, "mm"}, {"of the bed in the bootstrap replicates (error bars)", 5.0});
}

void read_sync(ObjectReader& r, SyncConfig& s) {
  auto& g = s.registration;
  r.number("max_rotation_deg", g.max_rotation_rad, {0, 45, "deg"}, {"largest rotation searched", 3.0});
  r.number("rotation_step_deg", g.rotation_step_rad, {0.1, 10, "deg"}, {"of the exhaustive search", 1.0});
  r.numbers("scales", g.scales, {0.5, 2, "1"}, 1, 21, {"scale factors searched", std::vector<double>{0.99, 1.0, 1.01}});
  r.number("min_overlap", g.min_overlap, {0.05, 1, "1"}, {"least overlap of the two pictures", 0.35});
  r.number("displacement_limit_mm", g.displacement_limit_m, {1, 500, "mm"}, {"largest displacement beyond the pose that is believed", 40.0});
  r.number("search_mm", s.score.search_m, {1, 200, "mm"}, {"score: a print vein looks this far for its body vein", 15.0});
  r.number("zone_mm", s.zones.zone_m, {20, 5000, "mm"}, {"score: side of the zones that get a verdict of their own, about", 200.0});
  r.object(
      "tolerance", "what print and body may be off by before the slab is waste",
      [&](ObjectReader& o) {
        auto& t = s.zones.tolerance;
        o.number("good_median_mm", t.good_median_m, {0.05, 50, "mm"}, {"largest median of the centre-line distance that is good", 1.0, true});
        o.number("good_p95_mm", t.good_p95_m, {0.05, 50, "mm"}, {"largest 95th percentile that is good", 2.0, true});
        o.number("fair_p95_mm", t.fair_p95_m, {0.05, 50, "mm"}, {"largest 95th percentile that is acceptable", 3.0, true});
        o.number("least_matched_length", t.least_matched, {0, 1, "1"}, {"least share of the vein length with a partner", 0.8, true});
      },
      false);
  r.number("vein_threshold", s.threshold, {0.05, 0.95, "1"}, {"score: vein where the vein fraction is above this", 0.5});
}

void read_masks(ObjectReader& r, MasksConfig& m) {
  r.number("preview_pitch_mm", m.preview_pitch_m, {0.05, 20, "mm"}, {"of masks/preview.png", 1.0});
  r.number("feather_mm", m.feather_m, {0, 200, "mm"}, {"transition between trusted and untrusted zones of the registration", 20.0});
}
}  // namespace venato::line
