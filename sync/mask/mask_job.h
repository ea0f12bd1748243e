#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
#include "base/context.h"
#include "graphics/graphic.h"
#include "graphics/raster/raster.h"
#include "graphics/tiff/tiff_file.h"
#include "sync/mask/feed_file.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// Which pixel value stands for "no ink"; the trap of printer files, so it is told by DotRange, by the sidecar and by this option.
enum class Polarity { zero_is_no_ink, zero_is_full_ink };

/// One layer of the graphic, all inks. Layers add up (saturating at full ink): a background without veins plus a layer of veins alone.
struct InkLayer {
  std::string name;
  graphics::Raster8 ink;  ///< channels = inks, 0 = no ink, 255 = full ink; print frame, own pitch; contone
  bool warp = true;       ///< true: follows the veins (print_from_green); false: stays at the pose
};

/// One powder as seen on the face of the slab, green frame. Give exactly one of the two rasters (one channel).
struct PowderMask {
  std::string name;
  graphics::RasterF fraction;           ///< 0..1
  graphics::RasterF signed_distance_m;  ///< positive inside the vein: coverage = clamp(1/2 + (distance + spread) / feather)
  double spread_m = 0.0003;             ///< trapping: about the median registration error (registration_print.md 5.3)
  double feather_m = 0.0006;            ///< width of the soft edge, > 0; at least the mixing width predicted by the line
};

/// The printer's ICC profile that the inks belong to.
struct MaskProfile {
  std::filesystem::path file;  ///< colours of preview.png come from it
  std::string bytes;           ///< go into print.tif (tag 34675) when 0 is no ink there, as profiles count
  std::string sha256, intent;
  graphics::ProfileUse use;
};

struct MaskJob {
  std::string slab_id, run_id;      ///< told in the sidecar and in ImageDescription; no effect on pixels
  std::vector<graphics::Ink> inks;  ///< 1..15; names [A-Za-z0-9_-]{1,40}: they become file names
  std::array<std::uint8_t, 3> body_srgb{};
  bool separated_without_profile = false;
  std::optional<MaskProfile> profile;  ///< none: preview.png by the inks' solids
  std::vector<InkLayer> layers;        ///< at least one
  Transform print_from_green;          ///< [m]
  Transform pose_from_green;           ///< used by layers with warp = false
  bool synchronised = true;            ///< false: registration failed and print_from_green is only a placement; told in the sidecar
  double width_m = 0, height_m = 0;    ///< of the green slab
  double dpi = 360;
  graphics::TiffCompression compression = graphics::TiffCompression::deflate;
  Polarity print_polarity = Polarity::zero_is_no_ink;       ///< print.tif
  Polarity ink_file_polarity = Polarity::zero_is_full_ink;  ///< print_<ink>.tif: Ghostscript tiffsep's convention
  std::vector<PowderMask> powders;
  bool powders_at_print_resolution = false;  ///< false: at the pitch of their rasters
  std::vector<FeedFile> feeds;
};

struct MaskFile {
  std::string name, role, polarity;  ///< role: print | ink | powder | feed_table | feed_picture | preview
  std::int64_t width_px = 0, height_px = 0;
  int channels = 0;
  double dpi = 0;
  std::uintmax_t bytes = 0;
  std::string sha256;
};
/// Where the time of the print files went [s]; for benches, no part of any file.
struct MaskTimes {
  double warp_s = 0, compress_s = 0, write_s = 0;  ///< summed over the threads: warp and preview sums; every file's compression; write calls
  double finish_s = 0;                             ///< wall: preview.png, fsync, SHA-256
};
struct MaskSet {
  std::int64_t width_px = 0, height_px = 0;
  double pitch_m = 0;
  bool big_tiff = false;
  double predicted_print_bytes = 0;  ///< from 2 % of the strips
  std::vector<MaskFile> files;       ///< without masks.json itself
  MaskTimes times;
};

/// Writes a job's printer files into `folder`:
///   print.tif            N inks, separated, InkNames, dpi; BigTIFF only when more than 3.6 GiB are predicted
///   print_<ink>.tif      one grey file per ink
///   powder_<name>.tif    coverage of each powder, 0 = none, 255 = full
///   feed_<head>.csv/.tif what the dosing heads are told
///   preview.png          sRGB, at most 1600 px high
///   masks.json           mm/px, frames, transform with its spline coefficients, ink order, polarity, files with sizes and SHA-256
/// Streams strips: memory = the source layers + a few strips of the print. All files appear together at the end; on any failure none does, and what
/// stood in the folder before stays. Same bytes for any thread count.
/// \throws UsageError for a job that makes no sense; WorkError (disk full and the like); Interrupted.
MaskSet write_masks(const MaskJob& job, const std::filesystem::path& folder, Context& context);

/// The sidecar's text.
std::string masks_json_text(const MaskJob& job, const MaskSet& set);
}  // namespace venato::sync
