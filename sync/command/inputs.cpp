#include "sync/command/inputs.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/error.h"
#include "base/units.h"
#include "graphics/colour/srgb.h"
#include "graphics/raster/mask.h"
#include "graphics/raster/resample.h"
#include "graphics/tiff/tiff_file.h"

namespace venato::sync {
namespace {

constexpr double kWorkPitch_m = 0.001;   // registration and score work at 1 px/mm (registration_print.md 1.3)
constexpr double kToneRatio = 2;         // light veins only when they cover clearly more than dark ones: marble is dark on white
constexpr double kMostVein = 0.5;        // a tone that covers more is the body seen against broad veins
constexpr double kFractionSlack = 0.01;  // float maps may leave 0..1 by interpolation, not by more

bool is_tiff(const std::filesystem::path& file) {
  char head[4] = {};
  std::ifstream(file, std::ios::binary).read(head, sizeof head);
  const std::string magic(head, 4);
  return magic == std::string("II*\0", 4) || magic == std::string("MM\0*", 4) || magic == std::string("II+\0", 4) || magic == std::string("MM\0+", 4);
}

int factor_to_work_pitch(double pitch_m) { return std::max(1, static_cast<int>(std::floor(kWorkPitch_m / pitch_m + 1e-6))); }

double pitch_of(const std::filesystem::path& file, std::optional<double> given_m, double dpi, const std::string& option) {
  if (given_m) {
    if (!(*given_m > 0) || !std::isfinite(*given_m)) throw UsageError(option + ": the pitch must be positive and finite, in mm per pixel");
    return *given_m;
  }
  if (!(dpi > 0)) throw UsageError(file.string() + ": has no dpi: give its mm per pixel with " + option);
  return kMetresPerInch / dpi;
}

/// Channels = powders, the first the body; one channel = the vein fraction itself.
graphics::RasterF vein_part(const graphics::RasterF& map, const std::filesystem::path& file) {
  graphics::RasterF out(map.width, map.height, 1, map.pitch_m);
  for (std::size_t k = 0; k < out.data.size(); ++k) {
    const float first = map.data[k * static_cast<std::size_t>(map.channels)];
    if (!(first >= -kFractionSlack && first <= 1 + kFractionSlack) && std::isfinite(first))
      throw UsageError(file.string() + ": float TIFF with value " + std::to_string(first) + ", fractions in 0..1 wanted");
    out.data[k] = map.channels > 1 ? 1 - first : first;
  }
  return out;
}

/// A separated TIFF has no colours of its own: the sum of inks as darkness is all that finding veins needs.
graphics::Raster8 darkness_picture(const graphics::Raster8& inks, std::uint8_t no_ink) {
  graphics::Raster8 out(inks.width, inks.height, 1, inks.pitch_m);
  for (std::size_t k = 0; k < out.data.size(); ++k) {
    int sum = 0;
    for (int c = 0; c < inks.channels; ++c) sum += inks.data[k * static_cast<std::size_t>(inks.channels) + static_cast<std::size_t>(c)] ^ no_ink;
    out.data[k] = static_cast<std::uint8_t>(255 - std::min(255, sum));
  }
  return out;
}

graphics::RasterF planned_fraction(const graphics::Raster8& picture, graphics::VeinPlanConfig config, graphics::VeinTone tone) {
  config.tone = tone;
  return graphics::channel(graphics::plan_veins(picture, config, {"body", "vein"}, 0, 1).fraction, 1);
}

void plan_picture(SyncInput& input, const graphics::VeinPlanConfig& plan, bool tone_given) {
  using graphics::VeinTone;
  // Beyond the valid part the picture goes on as it ends, so that neither its rim nor the darkness behind it reads as a vein.
  const graphics::Raster8 seen = input.valid.empty() ? input.picture : graphics::continued_outside(input.picture, input.valid);
  const auto planned = [&](VeinTone tone) {
    graphics::RasterF fraction = planned_fraction(seen, plan, tone);
    for (std::size_t k = 0; k < input.valid.data.size(); ++k)
      if (!input.valid.data[k]) fraction.data[k] = 0;
    return fraction;
  };
  if (tone_given) {
    input.tone = plan.tone;
    input.fraction = planned(plan.tone);
    return;
  }
  graphics::RasterF dark = planned(VeinTone::darker), light = planned(VeinTone::lighter);
  const auto as_vein = [](double share) { return share > kMostVein ? 0.0 : share; };
  input.tone = as_vein(vein_share(light, input.valid)) > kToneRatio * as_vein(vein_share(dark, input.valid)) ? VeinTone::lighter : VeinTone::darker;
  input.fraction = std::move(input.tone == VeinTone::darker ? dark : light);
}

}  // namespace

double vein_share(const graphics::RasterF& fraction, const graphics::Raster8& valid) {
  std::size_t n = 0, of = 0;
  for (std::size_t k = 0; k < fraction.data.size(); ++k) {
    if (!valid.empty() && !valid.data[k]) continue;
    n += fraction.data[k] >= 0.5f;
    ++of;
  }
  return of ? static_cast<double>(n) / static_cast<double>(of) : 0;
}

void keep_valid(graphics::Raster8& mask, const graphics::Raster8& valid) {
  for (std::size_t k = 0; k < valid.data.size(); ++k)
    if (!valid.data[k]) mask.data[k] = 0;
}

graphics::Raster8 vein_mask(const graphics::RasterF& fraction) {
  graphics::Raster8 out(fraction.width, fraction.height, 1, fraction.pitch_m);
  for (std::size_t k = 0; k < out.data.size(); ++k) out.data[k] = fraction.data[k] >= 0.5f ? 255 : 0;
  return out;
}

graphics::RasterF lightness(const graphics::Raster8& picture) {
  graphics::RasterF out(picture.width, picture.height, 1, picture.pitch_m);
  const auto channels = static_cast<std::size_t>(picture.channels);
  for (std::size_t k = 0; k < out.data.size(); ++k) {
    const std::uint8_t* p = picture.data.data() + k * channels;
    const graphics::Srgb8 rgb = channels == 3 ? graphics::Srgb8{p[0], p[1], p[2]} : graphics::Srgb8{p[0], p[0], p[0]};
    out.data[k] = static_cast<float>(graphics::lab_from_srgb(rgb).l / 100);
  }
  return out;
}

SyncInput load_input(const std::filesystem::path& file, std::optional<double> pitch_m, const std::string& pitch_option,
                     const graphics::VeinPlanConfig& plan, bool tone_given) {
  SyncInput input;
  input.file = file;
  input.pitch_from_file = !pitch_m;
  if (std::filesystem::is_regular_file(file) && is_tiff(file)) {
    const graphics::TiffInfo info = graphics::read_tiff_info(file);
    if (info.kind == graphics::TiffKind::fractions_f32) {
      const double pitch = pitch_of(file, pitch_m, info.dpi, pitch_option);
      graphics::RasterF map = graphics::read_tiff_f32(file);
      map.pitch_m = input.pitch_in_file_m = pitch;
      input.is_fraction_map = true;
      const graphics::RasterF fraction = vein_part(map, file);
      const int factor = factor_to_work_pitch(pitch);
      input.fraction = factor > 1 ? graphics::shrink(fraction, factor) : fraction;
      return input;
    }
    if (info.kind == graphics::TiffKind::separated) {
      const double pitch = pitch_of(file, pitch_m, info.dpi, pitch_option);
      graphics::Raster8 inks = graphics::read_tiff8(file);
      inks.pitch_m = input.pitch_in_file_m = pitch;
      input.picture = darkness_picture(inks, info.no_ink_value);
    }
  }
  if (input.picture.empty()) {
    if (pitch_m) pitch_of(file, pitch_m, 0, pitch_option);
    graphics::Picture loaded = graphics::load_picture(file, pitch_m);
    input.pitch_in_file_m = loaded.pixels.pitch_m;
    input.picture = std::move(loaded.pixels);
    input.has_colours = true;
  }
  const int factor = factor_to_work_pitch(input.picture.pitch_m);
  if (factor > 1) input.picture = graphics::shrink(input.picture, factor);
  plan_picture(input, plan, tone_given);
  return input;
}

SyncInput load_camera_input(const std::filesystem::path& file, const std::filesystem::path& camera, const graphics::VeinPlanConfig& plan,
                            bool tone_given, int threads) {
  const graphics::CameraView view = graphics::read_camera(camera);
  if (std::filesystem::is_regular_file(file) && is_tiff(file)) {
    const graphics::TiffKind kind = graphics::read_tiff_info(file).kind;
    if (kind == graphics::TiffKind::fractions_f32)
      throw UsageError(file.string() + ": is a vein map of a run, which lies in the slab's frame already; --camera is for camera pictures");
    if (kind == graphics::TiffKind::separated)
      throw UsageError(file.string() + ": is a separated TIFF (inks); --camera is for camera pictures (grey or RGB)");
  }
  SyncInput input;
  input.file = file;
  input.camera = graphics::rectify(graphics::load_picture(file, view.pitch_m).pixels, view, threads);
  input.pitch_in_file_m = view.pitch_m;
  input.picture = input.camera->picture;
  input.valid = input.camera->valid;
  if (const int factor = factor_to_work_pitch(view.pitch_m); factor > 1) {
    input.picture = graphics::shrink(input.picture, factor);
    input.valid = graphics::shrink(input.valid, factor);
    for (auto& v : input.valid.data) v = v == 255 ? 255 : 0;  // wholly seen
  }
  plan_picture(input, plan, tone_given);
  return input;
}

std::vector<EvidencePair> evidence_pairs(const SyncInput& vein_map, const SyncInput& graphic) {
  const auto of_fraction = [](const SyncInput& input) { return Evidence{input.fraction, input.valid, EvidenceKind::vein_fraction}; };
  const auto of_look = [&](const SyncInput& input) {
    return input.is_fraction_map ? of_fraction(input) : Evidence{lightness(input.picture), input.valid, EvidenceKind::picture};
  };
  std::vector<EvidencePair> pairs;
  if (vein_map.is_fraction_map) pairs.push_back({"vein fraction against planned veins", of_fraction(vein_map), of_fraction(graphic)});
  if (!vein_map.is_fraction_map || !graphic.is_fraction_map)
    pairs.push_back(
        {vein_map.is_fraction_map ? "vein fraction against lightness" : "lightness against lightness", of_look(vein_map), of_look(graphic)});
  return pairs;
}

}  // namespace venato::sync
