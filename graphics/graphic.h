#pragma once
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
namespace venato::graphics {

struct Ink {
  std::string name;
  std::array<std::uint8_t, 3> solid_srgb{};  ///< colour of a fired 100 % patch
};

/// The ICC profile that a graphic was separated through.
struct ProfileUse {
  std::string description;  ///< its 'desc' tag
  /// [0, 1], of the pixels: colorimetric round trip off by a CIEDE2000 difference over 3. NaN when no colour was turned into inks.
  double out_of_gamut_share = std::numeric_limits<double>::quiet_NaN();
};

/// The inkjet graphic in its own frame (print frame before synchronisation): N ink channels, 0 = no ink, 255 = full ink.
struct Graphic {
  std::vector<Ink> inks;
  std::array<std::uint8_t, 3> body_srgb{};  ///< unprinted body
  Raster8 ink;                              ///< channels = inks
  Raster8 srgb;                             ///< 3 channels: what it looks like
  bool separated_without_profile = false;   ///< true: colours are a preview, geometry is exact
  std::optional<ProfileUse> profile;        ///< set by separate_by_profile
};

/// PNG, JPEG or TIFF picture. Pitch: `pitch_m` if given, else the dpi in the file (TIFF, PNG pHYs, JFIF).
/// 1 or 3 channels 8 bit (16 bit is reduced, alpha is composed on white). Decodes nothing before the size in the header has been checked.
/// \throws UsageError naming file and reason: missing, 0 bytes, truncated, not an image, no pitch, more than max_pixels.
struct Picture {
  Raster8 pixels;  ///< channels 1 or 3 (sRGB order R, G, B)
  bool pitch_from_file = false;
};
Picture load_picture(const std::filesystem::path& file, std::optional<double> pitch_m, double max_pixels = 2.5e8);

/// RGB -> inks by non-negative least squares in log reflectance (registration_print.md 6.3), 33^3 table, <= max_inks_per_pixel, total ink limit.
Graphic separate(const Raster8& srgb, const std::vector<Ink>& inks, std::array<std::uint8_t, 3> body_srgb, double total_ink_limit = 2.4,
                 int max_inks_per_pixel = 3);
/// The same model forward: inks -> sRGB preview.
std::array<std::uint8_t, 3> predict_srgb(const std::vector<Ink>& inks, std::array<std::uint8_t, 3> body_srgb, const std::uint8_t* amounts);
/// A whole picture of ink amounts (one channel per ink, 255 = full ink).
Raster8 predict_srgb(const std::vector<Ink>& inks, std::array<std::uint8_t, 3> body_srgb, const Raster8& amounts);

/// Atomic writers (PNG, JPEG) for figures; `dpi` 0 = from pitch.
void write_png(const std::filesystem::path& file, const Raster8& image);
std::string encode_png(const Raster8& image);
std::string encode_jpeg(const Raster8& image, int quality);
}  // namespace venato::graphics
