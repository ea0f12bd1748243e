#include "line/report/html.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "base/error.h"
namespace venato::line {

std::string html_escape(std::string_view text) {
  std::string out;
  for (char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string base64(std::string_view bytes) {
  static constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[k])) : 0u; };
    const std::uint32_t v = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    out += kAlphabet[v >> 18 & 63];
    out += kAlphabet[v >> 12 & 63];
    out += i + 1 < bytes.size() ? kAlphabet[v >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? kAlphabet[v & 63] : '=';
  }
  return out;
}

std::string data_uri(std::string_view name, std::string_view bytes) {
  const auto type = name.ends_with(".png") ? "image/png" : name.ends_with(".svg") ? "image/svg+xml" : name.ends_with(".jpg") ? "image/jpeg" : nullptr;
  if (!type) throw UsageError(std::string(name) + ": a figure must be png, svg or jpg");
  return std::string("data:") + type + ";base64," + base64(bytes);
}

std::string pretty_number(double value, std::string_view unit) {
  if (!std::isfinite(value)) return "–";
  struct Scale {
    std::string_view unit;
    double factor;
    const char* shown;
    double above;  ///< use it when |value| reaches this
  };
  // In order of preference for each unit; the last one always fits.
  static constexpr std::array<Scale, 12> kScales{{{"m", 1, "m", 1},
                                                  {"m", 1e3, "mm", 1e-4},
                                                  {"m", 1e6, "µm", 0},
                                                  {"s", 1, "s", 1},
                                                  {"s", 1e3, "ms", 1e-4},
                                                  {"s", 1e6, "µs", 0},
                                                  {"kg/s", 1, "kg/s", 1},
                                                  {"kg/s", 1e3, "g/s", 0},
                                                  {"Pa", 1e-6, "MPa", 1e5},
                                                  {"Pa", 1e-3, "kPa", 1e3},
                                                  {"m²/s", 1e6, "mm²/s", 0},
                                                  {"kg", 1, "kg", 0}}};
  double shown = value;
  std::string_view shown_unit = unit;
  for (const auto& s : kScales)
    if (s.unit == unit && std::abs(value) >= s.above) {
      shown = value * s.factor;
      shown_unit = s.shown;
      break;
    }
  char text[64];
  const double size = std::abs(shown);
  if (size >= 1000 && size < 1e6)
    std::snprintf(text, sizeof text, "%.0f", shown);
  else
    std::snprintf(text, sizeof text, "%.3g", shown);
  std::string out = text;
  if (!shown_unit.empty()) out.append(" ").append(shown_unit);
  return out;
}
}  // namespace venato::line
