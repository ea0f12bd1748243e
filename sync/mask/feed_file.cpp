#include "sync/mask/feed_file.h"

#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/units.h"
#include "graphics/tiff/tiff_file.h"
#include "sync/mask/names.h"

namespace venato::sync {
namespace {

constexpr double kMinPitch_m = 1e-5;  // below this the "dpi" would not fit the printers' tables

void append(std::string& out, double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;  // shortest text that reads back as the same number
  out.append(text, end);
}

void append_line(std::string& out, const char* what, double value, const char* unit) {
  out += "# ";
  out += what;
  out += ": ";
  append(out, value);
  out += unit;
  out += '\n';
}

}  // namespace

void check_feed(const FeedFile& feed) {
  const auto refuse = [&](const std::string& why) { throw UsageError("feed '" + feed.name + "': " + why); };
  if (!is_file_name_part(feed.name)) refuse("the name goes into a file name: use 1 to 40 of A-Z a-z 0-9 _ -");
  if (feed.prongs < 1 || feed.ticks < 1) refuse("needs at least one prong and one tick");
  if (!(feed.prong_pitch_m >= kMinPitch_m) || !(feed.tick_s > 0) || !(feed.belt_speed_m_s > 0))
    refuse("prong pitch, tick and belt speed must be positive");
  if (feed.duty.size() != static_cast<std::size_t>(feed.prongs) * static_cast<std::size_t>(feed.ticks))
    refuse(std::to_string(feed.duty.size()) + " duties for " + std::to_string(feed.ticks) + " ticks of " + std::to_string(feed.prongs) + " prongs");
  for (std::size_t k = 0; k < feed.duty.size(); ++k)
    if (!(feed.duty[k] >= 0 && feed.duty[k] <= 1)) {
      const auto prongs = static_cast<std::size_t>(feed.prongs);
      refuse("duty " + std::to_string(feed.duty[k]) + " of prong " + std::to_string(k % prongs) + " at tick " + std::to_string(k / prongs) +
             " is outside [0, 1]");
    }
}

std::string feed_csv_text(const FeedFile& feed) {
  std::string out = "# venato feed commands, version 1\n# head: " + feed.name + "\n# powder: " + feed.powder + "\n";
  append_line(out, "prongs", feed.prongs, "");
  append_line(out, "ticks", feed.ticks, "");
  append_line(out, "prong_pitch", feed.prong_pitch_m * 1e3, " mm (prong p covers x in [p, p+1) * pitch)");
  append_line(out, "tick", feed.tick_s * 1e3, " ms");
  append_line(out, "belt_speed", feed.belt_speed_m_s, " m/s");
  append_line(out, "full_rate", feed.full_rate_kg_m2, " kg/m2 (areal mass at duty 1)");
  out += "# time_ms: start of the tick from the start of the lead-in; prong_k: duty, 0 = off, 1 = full\ntime_ms";
  for (int p = 0; p < feed.prongs; ++p) out += ",prong_" + std::to_string(p);
  out += '\n';
  for (int k = 0; k < feed.ticks; ++k) {
    append(out, std::round(k * feed.tick_s * 1e9) / 1e6);  // nanoseconds: hides the rounding of k * tick
    const double* row = feed.duty.data() + static_cast<std::size_t>(k) * static_cast<std::size_t>(feed.prongs);
    for (int p = 0; p < feed.prongs; ++p) {
      out += ',';
      append(out, row[p]);
    }
    out += '\n';
  }
  return out;
}

void write_feed(const FeedFile& feed, const std::filesystem::path& folder) {
  check_feed(feed);
  write_text_atomically(folder / ("feed_" + feed.name + ".csv"), feed_csv_text(feed));
  graphics::Raster8 picture(feed.prongs, feed.ticks, 1, feed.prong_pitch_m);
  for (std::size_t k = 0; k < feed.duty.size(); ++k) picture.data[k] = static_cast<std::uint8_t>(std::lround(feed.duty[k] * 255));
  graphics::TiffInfo info;
  info.width = feed.prongs;
  info.height = feed.ticks;
  info.channels = 1;
  info.kind = graphics::TiffKind::grey;
  info.dpi = kMetresPerInch / feed.prong_pitch_m;
  info.software = "venato";
  std::string text = R"({"what":"feed commands, 0 = off, 255 = full duty","prong_pitch_mm":)";
  append(text, feed.prong_pitch_m * 1e3);
  text += R"(,"tick_length_mm":)";
  append(text, feed.tick_s * feed.belt_speed_m_s * 1e3);
  text += R"(,"tick_ms":)";
  append(text, feed.tick_s * 1e3);
  info.description = text + "}";
  graphics::write_tiff(folder / ("feed_" + feed.name + ".tif"), picture, info, 1);
}

}  // namespace venato::sync
