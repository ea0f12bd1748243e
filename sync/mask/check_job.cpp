#include "sync/mask/check_job.h"

#include <array>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/units.h"
#include "sync/mask/names.h"
#include "sync/warp/warp.h"

namespace venato::sync {
namespace {

constexpr double kMinDpi = 10, kMaxDpi = 1200;    // beyond any ceramic inkjet head
constexpr double kMaxSide_px = 300000;            // PSB's limit, and far inside TIFF's
constexpr int kMaxScreenedLevels = 4;             // a screened picture has 2 to 4 drop sizes; contone has tens of levels
constexpr std::size_t kMinPixelsToJudge = 65536;  // small test charts may be flat by design

[[noreturn]] void refuse(const std::string& why) { throw UsageError("masks: " + why); }

template <class Items, class Name>
void check_names(const Items& items, Name name, const char* what) {
  std::set<std::string> seen;
  for (const auto& item : items) {
    if (!is_file_name_part(name(item)))
      refuse(std::string(what) + " name '" + name(item) + "' goes into a file name: use 1 to 40 of A-Z a-z 0-9 _ -");
    if (!seen.insert(name(item)).second) refuse(std::string(what) + " name '" + name(item) + "' occurs twice: its file would be overwritten");
  }
}

/// Only 0, 255 and at most two levels between, and both ends in large numbers: dots, not tones. Interpolating dots would print a grey veil.
bool looks_screened(const graphics::Raster8& ink) {
  if (ink.data.size() < kMinPixelsToJudge) return false;
  std::array<std::size_t, 256> count{};
  std::size_t changes = 0;
  const auto step = static_cast<std::size_t>(ink.channels);
  for (std::size_t k = 0; k < ink.data.size(); ++k) {
    ++count[ink.data[k]];
    changes += k >= step && ink.data[k] != ink.data[k - step];
  }
  int levels = 0;
  for (const std::size_t n : count) levels += n > 0;
  // Flat artwork has few levels too, but long runs; dots change at every few pixels.
  return levels >= 2 && levels <= kMaxScreenedLevels && changes * 5 > ink.data.size();
}

bool is_finite(const Transform& map) { return map.a.allFinite() && map.t.allFinite(); }

void check_powder(const PowderMask& powder) {
  const std::string what = "powder '" + powder.name + "' ";
  if (powder.fraction.empty() == powder.signed_distance_m.empty()) refuse(what + "needs either a fraction or a signed distance");
  const graphics::RasterF& raster = powder.fraction.empty() ? powder.signed_distance_m : powder.fraction;
  if (raster.channels != 1 || !(raster.pitch_m > 0)) refuse(what + "needs one channel and a pitch");
  if (powder.fraction.empty() && !(powder.feather_m > 0)) refuse(what + "needs a feather above 0 mm");
}

}  // namespace

void check_job(const MaskJob& job) {
  if (!(job.width_m > 0) || !(job.height_m > 0)) refuse("the slab needs a width and a height");
  if (!(job.dpi >= kMinDpi && job.dpi <= kMaxDpi)) refuse(std::to_string(job.dpi) + " dpi is outside [10, 1200]");
  if (std::max(job.width_m, job.height_m) * job.dpi / kMetresPerInch > kMaxSide_px) refuse("more than 300000 px on a side");
  if (job.inks.empty() || job.inks.size() > kMaxWarpChannels)
    refuse(std::to_string(job.inks.size()) + " inks are outside [1, " + std::to_string(kMaxWarpChannels) + "]");
  check_names(
      job.inks, [](const graphics::Ink& ink) { return ink.name; }, "ink");
  check_names(
      job.powders, [](const PowderMask& powder) { return powder.name; }, "powder");
  check_names(
      job.feeds, [](const FeedFile& feed) { return feed.name; }, "feed");
  if (job.layers.empty()) refuse("the graphic has no layer");
  for (const InkLayer& layer : job.layers) {
    const std::string what = "layer '" + layer.name + "' ";
    if (layer.ink.channels != static_cast<int>(job.inks.size()))
      refuse(what + "has " + std::to_string(layer.ink.channels) + " channels for " + std::to_string(job.inks.size()) + " inks");
    if (layer.ink.empty() || !(layer.ink.pitch_m > 0)) refuse(what + "is empty or has no pitch");
    if (looks_screened(layer.ink))
      refuse(what + "is screened (2 to 4 levels in dots), it cannot be warped: give the contone file from before screening");
  }
  if (!is_finite(job.print_from_green) || !is_finite(job.pose_from_green)) refuse("the transform has values that are not numbers");
  for (const PowderMask& powder : job.powders) check_powder(powder);
  for (const FeedFile& feed : job.feeds) check_feed(feed);
}

}  // namespace venato::sync
