#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/expects.h"
#include "graphics/colour/srgb.h"
#include "graphics/icc/profile_lcms.h"
#include "graphics/icc/separate_by_profile.h"
namespace venato::graphics {
namespace {
constexpr double kOutOfGamut_dE00 = 3;           // registration_print notes 6.2
constexpr std::size_t kSampledPixels = 1 << 18;  // the share is then known to about 0.1 %

cmsUInt32Number lcms_intent(RenderingIntent intent) {
  switch (intent) {
    case RenderingIntent::perceptual:
      return INTENT_PERCEPTUAL;
    case RenderingIntent::relative_colorimetric:
      return INTENT_RELATIVE_COLORIMETRIC;
    case RenderingIntent::saturation:
      return INTENT_SATURATION;
    case RenderingIntent::absolute_colorimetric:
      return INTENT_ABSOLUTE_COLORIMETRIC;
  }
  return INTENT_PERCEPTUAL;
}

void transform_rows(cmsHTRANSFORM t, const Raster8& in, Raster8& out, int threads) {
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int j = 0; j < in.height; ++j) cmsDoTransform(t, &in.at(0, j), &out.at(0, j), static_cast<cmsUInt32Number>(in.width));
}

Lab decoded(const std::array<cmsUInt16Number, 3>& code) {
  cmsCIELab lab;
  cmsLabEncoded2Float(&lab, code.data());
  return {lab.L, lab.a, lab.b};
}

/// Share of pixels whose colour the inks cannot make: to the inks by the colorimetric table and back, both exact (no precalculated grid).
/// Evenly spread pixels; each distinct colour is computed once.
double out_of_gamut_share(const icc::OutputProfile& profile, const Raster8& srgb) {
  const std::size_t pixels = srgb.data.size() / 3, step = (pixels + kSampledPixels - 1) / kSampledPixels;
  std::vector<Srgb8> colours;
  for (std::size_t k = 0; k < pixels; k += step) colours.push_back({srgb.data[3 * k], srgb.data[3 * k + 1], srgb.data[3 * k + 2]});
  std::sort(colours.begin(), colours.end());
  const auto total = static_cast<double>(colours.size());
  constexpr cmsUInt32Number rel = INTENT_RELATIVE_COLORIMETRIC;
  const auto direct = profile.transform({{profile.srgb(), rel}, {profile.lab(), rel}}, TYPE_RGB_8, TYPE_Lab_16, cmsFLAGS_NOOPTIMIZE);
  const auto to_inks = profile.transform({{profile.srgb(), rel}, {profile.handle(), rel}}, TYPE_RGB_8, profile.ink_format(), cmsFLAGS_NOOPTIMIZE);
  const auto back = profile.transform({{profile.handle(), rel}, {profile.lab(), rel}}, profile.ink_format(), TYPE_Lab_16, cmsFLAGS_NOOPTIMIZE);
  std::ptrdiff_t outside = 0;
  std::vector<std::uint8_t> ink(static_cast<std::size_t>(profile.inks()));
  for (auto from = colours.begin(), to = from; from != colours.end(); from = to) {
    to = std::upper_bound(from, colours.end(), *from);
    std::array<cmsUInt16Number, 3> wanted{}, made{};  // 16 bit: Little CMS 2.14 has no floating point formats beside reversed grey
    cmsDoTransform(direct.get(), from->data(), wanted.data(), 1);
    cmsDoTransform(to_inks.get(), from->data(), ink.data(), 1);
    cmsDoTransform(back.get(), ink.data(), made.data(), 1);
    if (delta_e2000(decoded(wanted), decoded(made)) > kOutOfGamut_dE00) outside += to - from;
  }
  return static_cast<double>(outside) / total;
}
icc::Step seen_step(const icc::OutputProfile& p) { return {p.handle(), INTENT_ABSOLUTE_COLORIMETRIC}; }
icc::Step srgb_step(const icc::OutputProfile& p) { return {p.srgb(), INTENT_ABSOLUTE_COLORIMETRIC}; }

/// Names, the body (no ink) and the solids (one full ink) through the forward table.
void take_colours(const icc::OutputProfile& profile, Graphic& g) {
  const auto forward = profile.transform({seen_step(profile), srgb_step(profile)}, profile.ink_format(), TYPE_RGB_8, cmsFLAGS_NOOPTIMIZE);
  std::vector<std::uint8_t> amounts(static_cast<std::size_t>(profile.inks()), 0);
  cmsDoTransform(forward.get(), amounts.data(), g.body_srgb.data(), 1);
  for (std::size_t k = 0; k < amounts.size(); ++k) {
    Ink ink{profile.ink_names()[k], {}};
    amounts[k] = 255;
    cmsDoTransform(forward.get(), amounts.data(), ink.solid_srgb.data(), 1);
    amounts[k] = 0;
    g.inks.push_back(ink);
  }
}
}  // namespace

Graphic see_by_profile(const Raster8& ink, const std::filesystem::path& profile_file, int threads) {
  VENATO_EXPECTS(!ink.empty() && threads > 0);
  const icc::OutputProfile profile(profile_file);
  if (ink.channels != profile.inks())
    throw UsageError(profile_file.string() + ": is a profile of " + std::to_string(profile.inks()) + " inks; the graphic has " +
                     std::to_string(ink.channels));
  Graphic g;
  take_colours(profile, g);
  g.ink = ink;
  g.srgb = Raster8(ink.width, ink.height, 3, ink.pitch_m);
  // Without a precalculated grid: with many inks it would be coarser than the profile's own.
  transform_rows(profile.transform({seen_step(profile), srgb_step(profile)}, profile.ink_format(), TYPE_RGB_8, cmsFLAGS_NOOPTIMIZE).get(), ink,
                 g.srgb, threads);
  g.profile = ProfileUse{.description = profile.description()};
  return g;
}

ProfileInks read_profile_inks(const std::filesystem::path& profile_file) {
  const icc::OutputProfile profile(profile_file);
  Graphic g;
  take_colours(profile, g);
  return {profile.description(), g.inks, g.body_srgb};
}

std::string intent_name(RenderingIntent intent) {
  constexpr std::array kNames = {"perceptual", "relative_colorimetric", "saturation", "absolute_colorimetric"};
  return kNames.at(static_cast<std::size_t>(intent));
}

Graphic separate_by_profile(const Raster8& srgb, const std::filesystem::path& profile_file, RenderingIntent intent, int threads) {
  VENATO_EXPECTS(srgb.channels == 3 && !srgb.empty() && threads > 0);
  const icc::OutputProfile profile(profile_file);
  const auto wanted = lcms_intent(intent);
  const icc::Step from_srgb{profile.srgb(), wanted}, to_inks{profile.handle(), wanted}, seen = seen_step(profile), to_srgb = srgb_step(profile);

  Graphic g;
  take_colours(profile, g);
  g.ink = Raster8(srgb.width, srgb.height, profile.inks(), srgb.pitch_m);
  transform_rows(profile.transform({from_srgb, to_inks}, TYPE_RGB_8, profile.ink_format(), 0).get(), srgb, g.ink, threads);
  // The preview in one transform RGB -> inks -> RGB: its grid has 3 axes; one over the inks would have up to 15.
  g.srgb = Raster8(srgb.width, srgb.height, 3, srgb.pitch_m);
  transform_rows(profile.transform({from_srgb, to_inks, seen, to_srgb}, TYPE_RGB_8, TYPE_RGB_8, 0).get(), srgb, g.srgb, threads);
  g.profile = ProfileUse{profile.description(), out_of_gamut_share(profile, srgb)};
  return g;
}
}  // namespace venato::graphics
