#pragma once
/// sRGB -> inks through the user's own ICC output profile (Little CMS 2). Source: ICC.1:2022 (profile format); registration_print notes 6.2.
#include <filesystem>
#include <string>
#include <vector>

#include "graphics/colour/srgb.h"
#include "graphics/graphic.h"
namespace venato::graphics {

/// How colours that the printer cannot make are mapped: the profile's own table BToA0, BToA1, BToA2, or BToA1 with the body's white kept.
enum class RenderingIntent { perceptual, relative_colorimetric, saturation, absolute_colorimetric };

/// \param srgb 3 channels R, G, B
/// \param profile output profile (class 'prtr') with 1 to 15 inks: GRAY, CMYK or 2CLR to FCLR, with device -> PCS and PCS -> device tables
/// \param threads >= 1; the bytes do not depend on it
/// \return ink: the profile's amounts, its own ink limit is in them; names: its colorant table 'clrt' with everything but letters, digits, _ and -
///   turned into _, else cyan, magenta, yellow, black, or ink_1 …; solid_srgb and body_srgb: one full ink and no ink through the forward table,
///   absolute colorimetric; srgb: the inks seen through it (preview, within the accuracy of a 33^3 grid). separated_without_profile is false.
///   profile: the description and the share of pixels out of gamut.
/// \throws UsageError naming the file, what it is and what is wanted: missing, truncated, not an ICC profile, another class or colour space
///   (display, scanner, device link; RGB; over 15 inks), no table to the inks or back, damaged tables.
Graphic separate_by_profile(const Raster8& srgb, const std::filesystem::path& profile, RenderingIntent intent, int threads);
/// Ink amounts as they are, with names, colours and the picture (srgb) from the profile's forward table. The share out of gamut is NaN: nothing was
/// mapped. \param ink channels = inks of the profile, 0 = no ink \throws UsageError as above, and when the channels differ
Graphic see_by_profile(const Raster8& ink, const std::filesystem::path& profile, int threads);
/// What the profile says without any picture. \throws UsageError as above
struct ProfileInks {
  std::string description;
  std::vector<Ink> inks;
  Srgb8 body_srgb{};
};
ProfileInks read_profile_inks(const std::filesystem::path& profile);
/// "perceptual", "relative_colorimetric", …
std::string intent_name(RenderingIntent intent);
}  // namespace venato::graphics
