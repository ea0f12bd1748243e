#pragma once
/// Pictures for the report: a raster with its scale, legend and title. All text is ASCII (OpenCV's stroke font).
#include <string>
#include <vector>
#include "graphics/colour/srgb.h"
#include "graphics/draw/palette.h"
#include "graphics/raster/raster.h"
namespace venato::graphics {

struct MapStyle {
  std::string title;
  std::string label;  ///< quantity with unit, at the colour bar: "misfit [mm]"
  double low = 0;     ///< value of the first colour
  double high = 0;    ///< value of the last one; low == high: the 1 % and 99 % quantiles of the finite values (0 in the middle if diverging)
  Palette palette = Palette::viridis;
  int max_width_px = 900;  ///< of the picture area; wider rasters are area-averaged down
};
/// One-channel raster (NaN = no value, white) with colour bar and mm scale bar.
Raster8 draw_map(const RasterF& values, const MapStyle& style);

struct LegendEntry {
  std::string text;
  Srgb8 colour{};
};
/// A finished sRGB picture with title, scale bar and legend; pitch 0: no scale bar.
Raster8 draw_picture(const Raster8& srgb, const std::string& title, const std::vector<LegendEntry>& legend = {}, int max_width_px = 900);

/// Colours of the overlay; colour-blind-safe.
inline constexpr Srgb8 kOverlayBody{230, 130, 20}, kOverlayPrint{30, 110, 200}, kOverlayBoth{45, 45, 45}, kOverlayGround{247, 246, 243};
/// Two vein fractions (0 to 1) of the same size, one over the other: only the first, only the second, both. No frame or legend.
Raster8 overlay(const RasterF& body_vein, const RasterF& print_vein);
/// The same with title, legend, scale bar.
Raster8 draw_overlay(const RasterF& body_vein, const RasterF& print_vein, const std::string& title, const std::string& body_label = "body vein only",
                     const std::string& print_label = "print vein only", int max_width_px = 900);

/// Cut through the slab, drawn wide and short as it is, z up, each row of cells `z_exaggeration` times as high as wide cells would be.
/// \param fraction width = positions along the cut, height = layers, row 0 the bottom face; channels = powders, sum 1
/// \param length_m of the cut, \param thickness_m of the slab
Raster8 draw_section(const RasterF& fraction, const std::vector<Srgb8>& powder_colours, const std::vector<std::string>& powder_names, double length_m,
                     double thickness_m, double z_exaggeration, const std::string& title, int width_px = 900);
}  // namespace venato::graphics
