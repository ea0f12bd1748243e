#include "base/plot/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/plot/ticks.h"

namespace venato {
namespace {
// Okabe and Ito's colour-blind-safe cycle, black last (axes are dark already).
constexpr std::array<const char*, 7> kCycle = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
constexpr double kLeft_px = 64, kRight_px = 14, kTop_px = 30, kBottom_px = 46, kLegendRow_px = 16;

struct Frame {
  double x0, x1, y0, y1;            ///< data
  double left, right, top, bottom;  ///< pixels
  double px(double x) const { return left + (x - x0) / (x1 - x0) * (right - left); }
  double py(double y) const { return bottom - (y - y0) / (y1 - y0) * (bottom - top); }
};

std::string num(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", v);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

void text_at(std::string& svg, double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  svg += std::string("<text x=\"") + num(x) + "\" y=\"" + num(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" + escaped(text) + "</text>\n";
}

std::pair<double, double> data_range(const Plot& plot, bool along_x) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto take = [&](const std::vector<double>& values) {
    for (const double v : values) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
  };
  for (const Series& s : plot.series) {
    take(along_x ? s.x : s.y);
    if (along_x) continue;
    take(s.y_low);
    take(s.y_high);
  }
  if (!(low <= high)) return {0, 1};  // nothing to show
  if (low == high) {
    const double half = low == 0 ? 1 : std::abs(low) * 0.5;
    return {low - half, high + half};
  }
  const double margin = along_x ? 0 : 0.04 * (high - low);
  return {low - margin, high + margin};
}

std::pair<double, double> usable(std::pair<double, double> range) {
  if (std::isfinite(range.first) && std::isfinite(range.second) && range.first < range.second) return range;
  return {0, 1};
}

void draw_axes(std::string& svg, const Plot& plot, const Frame& f) {
  const Ticks xt = round_ticks(f.x0, f.x1, std::max(2, static_cast<int>((f.right - f.left) / 80)));
  const Ticks yt = round_ticks(f.y0, f.y1, std::max(2, static_cast<int>((f.bottom - f.top) / 45)));
  svg += "<g stroke=\"#dddddd\" stroke-width=\"1\">\n";
  for (const double v : xt.values) svg += std::string("<path d=\"M") + num(f.px(v)) + " " + num(f.top) + "V" + num(f.bottom) + "\"/>\n";
  for (const double v : yt.values) svg += std::string("<path d=\"M") + num(f.left) + " " + num(f.py(v)) + "H" + num(f.right) + "\"/>\n";
  svg += "</g>\n";
  for (std::size_t i = 0; i < xt.values.size(); ++i) text_at(svg, f.px(xt.values[i]), f.bottom + 15, "middle", xt.labels[i]);
  for (std::size_t i = 0; i < yt.values.size(); ++i) text_at(svg, f.left - 6, f.py(yt.values[i]) + 4, "end", yt.labels[i]);
  svg += std::string("<rect x=\"") + num(f.left) + "\" y=\"" + num(f.top) + "\" width=\"" + num(f.right - f.left) + "\" height=\"" +
         num(f.bottom - f.top) + "\" fill=\"none\" stroke=\"#444444\"/>\n";
  text_at(svg, (f.left + f.right) / 2, f.top - 10, "middle", plot.title, " font-weight=\"bold\"");
  text_at(svg, (f.left + f.right) / 2, f.bottom + 34, "middle", plot.x_label);
  const std::string turn = std::string(" transform=\"rotate(-90 14 ") + num((f.top + f.bottom) / 2) + ")\"";
  text_at(svg, 14, (f.top + f.bottom) / 2, "middle", plot.y_label, turn.c_str());
}

bool shown(const Series& s, std::size_t i) { return i < s.x.size() && i < s.y.size() && std::isfinite(s.x[i]) && std::isfinite(s.y[i]); }
bool has_bounds(const Series& s, std::size_t i) {
  return i < s.x.size() && i < s.y_low.size() && i < s.y_high.size() && std::isfinite(s.x[i]) && std::isfinite(s.y_low[i]) &&
         std::isfinite(s.y_high[i]);
}

/// NaN interrupts a line: the gap is visible.
void draw_line(std::string& svg, const Series& s, const Frame& f, const std::string& colour) {
  std::string d;
  bool pen_down = false;
  double last_y = 0;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!shown(s, i)) {
      pen_down = false;
      continue;
    }
    const double x = f.px(s.x[i]), y = f.py(s.y[i]);
    if (pen_down && s.style == SeriesStyle::steps) d += std::string("L") + num(x) + " " + num(last_y);
    d += std::string(pen_down ? "L" : "M") + num(x) + " " + num(y);
    pen_down = true;
    last_y = y;
  }
  if (!d.empty()) svg += "<path d=\"" + d + "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"1.6\"/>\n";
}

void draw_band(std::string& svg, const Series& s, const Frame& f, const std::string& colour) {
  std::string upper, lower;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!has_bounds(s, i)) continue;
    upper += std::string(upper.empty() ? "M" : "L") + num(f.px(s.x[i])) + " " + num(f.py(s.y_high[i]));
    lower = std::string("L") + num(f.px(s.x[i])) + " " + num(f.py(s.y_low[i])) + lower;
  }
  if (!upper.empty()) svg += "<path d=\"" + upper + lower + "Z\" fill=\"" + colour + "\" fill-opacity=\"0.22\" stroke=\"none\"/>\n";
}

void draw_points(std::string& svg, const Series& s, const Frame& f, const std::string& colour) {
  for (std::size_t i = 0; i < s.x.size(); ++i)
    if (shown(s, i))
      svg += std::string("<circle cx=\"") + num(f.px(s.x[i])) + "\" cy=\"" + num(f.py(s.y[i])) + "\" r=\"3\" fill=\"" + colour + "\"/>\n";
}

void draw_error_bars(std::string& svg, const Series& s, const Frame& f, const std::string& colour) {
  for (std::size_t i = 0; i < s.x.size(); ++i)
    if (has_bounds(s, i))
      svg += std::string("<path d=\"M") + num(f.px(s.x[i])) + " " + num(f.py(s.y_low[i])) + "V" + num(f.py(s.y_high[i])) + "\" stroke=\"" + colour +
             "\"/>\n";
}

void draw_legend(std::string& svg, const Plot& plot, const Frame& f, const std::vector<std::string>& colours) {
  double y = f.top + 14;
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    if (plot.series[k].label.empty()) continue;
    const double x = f.right - 10;
    svg += std::string("<rect x=\"") + num(x - 12) + "\" y=\"" + num(y - 9) + "\" width=\"12\" height=\"9\" fill=\"" + colours[k] + "\"/>\n";
    text_at(svg, x - 18, y, "end", plot.series[k].label, " paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\"");
    y += kLegendRow_px;
  }
}
}  // namespace

std::string svg_plot(const Plot& plot, int width_px, int height_px) {
  const auto [x0, x1] = usable(plot.x_range.value_or(data_range(plot, true)));
  const auto [y0, y1] = usable(plot.y_range.value_or(data_range(plot, false)));
  const Frame f{x0, x1, y0, y1, kLeft_px, width_px - kRight_px, kTop_px, height_px - kBottom_px};
  const std::string size = std::to_string(width_px) + "\" height=\"" + std::to_string(height_px);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " + std::to_string(width_px) + " " +
                    std::to_string(height_px) + "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n<rect width=\"" + size +
                    "\" fill=\"#ffffff\"/>\n";
  draw_axes(svg, plot, f);
  // Several plots may stand in one HTML page: the nested svg clips without an id.
  svg += std::string("<svg x=\"") + num(f.left) + "\" y=\"" + num(f.top) + "\" width=\"" + num(f.right - f.left) + "\" height=\"" +
         num(f.bottom - f.top) + "\" viewBox=\"" + num(f.left) + " " + num(f.top) + " " + num(f.right - f.left) + " " + num(f.bottom - f.top) +
         "\">\n";
  std::vector<std::string> colours;
  for (const Series& s : plot.series) {
    const std::string colour = s.colour.empty() ? kCycle[colours.size() % kCycle.size()] : escaped(s.colour);
    colours.push_back(colour);
    if (s.style == SeriesStyle::band) draw_band(svg, s, f, colour);
    if (s.style == SeriesStyle::points) draw_points(svg, s, f, colour);
    if (s.style != SeriesStyle::points) draw_line(svg, s, f, colour);
    if (s.style != SeriesStyle::band) draw_error_bars(svg, s, f, colour);
  }
  svg += "</svg>\n";
  draw_legend(svg, plot, f, colours);
  return svg + "</svg>\n";
}
}  // namespace venato
