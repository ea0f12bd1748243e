#include <cmath>
#include <nlohmann/json.hpp>

#include "sync/mask/mask_job.h"

namespace venato::sync {
namespace {

using Json = nlohmann::ordered_json;

std::string hex_colour(std::array<std::uint8_t, 3> rgb) {
  constexpr char digits[] = "0123456789abcdef";
  std::string text = "#";
  for (const auto v : rgb) {
    text += digits[v >> 4];
    text += digits[v & 15];
  }
  return text;
}

std::vector<double> in_mm(const std::vector<double>& metres) {
  std::vector<double> out;
  for (const double v : metres) out.push_back(v * 1e3);
  return out;
}

Json transform_json(const Transform& map) {
  Json out;
  out["formula"] = "print_mm = a * (green_mm + u(green_mm)) + t_mm";
  out["a"] = {{map.a(0, 0), map.a(0, 1)}, {map.a(1, 0), map.a(1, 1)}};
  out["t_mm"] = {map.t.x() * 1e3, map.t.y() * 1e3};
  if (map.u.spacing_m > 0) {
    out["u"] = {{"kind", "uniform cubic B-spline; coefficient (i, j) is centred on origin + spacing * (i - 1, j - 1); constant outside"},
                {"origin_mm", {map.u.origin_m.x() * 1e3, map.u.origin_m.y() * 1e3}},
                {"spacing_mm", map.u.spacing_m * 1e3},
                {"nx", map.u.nx},
                {"ny", map.u.ny},
                {"order", "row by row, nx coefficients each"},
                {"coefficients_x_mm", in_mm(map.u.cx)},
                {"coefficients_y_mm", in_mm(map.u.cy)}};
  } else {
    out["u"] = nullptr;
  }
  return out;
}

const char* polarity_text(Polarity p) { return p == Polarity::zero_is_no_ink ? "0 = no ink, 255 = full ink" : "0 = full ink, 255 = no ink"; }

}  // namespace

std::string masks_json_text(const MaskJob& job, const MaskSet& set) {
  Json out;
  out["format"] = "venato-masks";
  out["version"] = 1;
  out["slab_id"] = job.slab_id;
  out["run_id"] = job.run_id;
  out["synchronised"] = job.synchronised;
  out["frame"] =
      "green: pressed slab before drying and firing; origin at its first corner = top-left of every file, x across the belt, y along it; "
      "pixel centres at (i + 1/2, j + 1/2)";
  out["width_mm"] = job.width_m * 1e3;
  out["height_mm"] = job.height_m * 1e3;
  out["dpi"] = job.dpi;
  out["mm_per_px"] = set.pitch_m * 1e3;
  out["width_px"] = set.width_px;
  out["height_px"] = set.height_px;
  out["big_tiff"] = set.big_tiff;
  out["interpolation"] = "bilinear, contone 8 bit";
  out["polarity"] = {{"print.tif", polarity_text(job.print_polarity)},
                     {"print_<ink>.tif", polarity_text(job.ink_file_polarity)},
                     {"powder_<name>.tif", "0 = no powder, 255 = full coverage"},
                     {"feed_<head>.tif", "0 = off, 255 = full duty"}};
  out["inks"] = Json::array();
  for (std::size_t k = 0; k < job.inks.size(); ++k)
    out["inks"].push_back({{"order", k}, {"name", job.inks[k].name}, {"solid_srgb", hex_colour(job.inks[k].solid_srgb)}});
  out["body_srgb"] = hex_colour(job.body_srgb);
  if (job.separated_without_profile) out["colour_note"] = "separated without a printer profile: colours are a preview, geometry is exact";
  const double share = job.profile ? job.profile->use.out_of_gamut_share : 0;
  if (job.profile)
    out["profile"] = {{"description", job.profile->use.description},
                      {"file", job.profile->file.filename().string()},
                      {"sha256", job.profile->sha256},
                      {"intent", job.profile->intent},
                      {"out_of_gamut_share", std::isfinite(share) ? Json(share) : Json(nullptr)}};
  out["layers"] = Json::array();
  for (const InkLayer& layer : job.layers)
    out["layers"].push_back({{"name", layer.name},
                             {"moved_by", layer.warp ? "print_from_green" : "pose_from_green"},
                             {"source_mm_per_px", layer.ink.pitch_m * 1e3},
                             {"source_width_px", layer.ink.width},
                             {"source_height_px", layer.ink.height}});
  out["print_from_green"] = transform_json(job.print_from_green);
  out["pose_from_green"] = transform_json(job.pose_from_green);
  out["powders"] = Json::array();
  for (const PowderMask& powder : job.powders) {
    Json entry = {{"name", powder.name}, {"from", powder.fraction.empty() ? "signed distance" : "fraction"}};
    if (powder.fraction.empty()) {
      entry["spread_mm"] = powder.spread_m * 1e3;
      entry["feather_mm"] = powder.feather_m * 1e3;
    }
    out["powders"].push_back(std::move(entry));
  }
  out["feeds"] = Json::array();
  for (const FeedFile& feed : job.feeds)
    out["feeds"].push_back({{"name", feed.name},
                            {"powder", feed.powder},
                            {"prongs", feed.prongs},
                            {"ticks", feed.ticks},
                            {"prong_pitch_mm", feed.prong_pitch_m * 1e3},
                            {"tick_ms", feed.tick_s * 1e3},
                            {"belt_speed_m_s", feed.belt_speed_m_s},
                            {"full_rate_kg_m2", feed.full_rate_kg_m2}});
  out["files"] = Json::array();
  for (const MaskFile& file : set.files) {
    Json entry = {{"name", file.name}, {"role", file.role}};
    if (!file.polarity.empty()) entry["polarity"] = file.polarity;
    if (file.width_px > 0) {
      entry["width_px"] = file.width_px;
      entry["height_px"] = file.height_px;
      entry["channels"] = file.channels;
      entry["dpi"] = file.dpi;
    }
    entry["bytes"] = file.bytes;
    entry["sha256"] = file.sha256;
    out["files"].push_back(std::move(entry));
  }
  // Names and ids may come from a user's file in any encoding: replace what is not UTF-8 instead of failing at the very end.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace venato::sync
