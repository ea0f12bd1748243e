#include "line/commands/plan_head.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/expects.h"
namespace venato::line {
namespace {
constexpr double kWholeTolerance = 1e-6;  // relative: what decimal pitches in a config can miss a whole number by

double strip_length(const LineBasics& b) { return b.grid.ny * b.grid.pitch_m; }

/// Weights of source pixels [0, n) for an interval [low, high) given in pixels. Up to `bleed` pixels outside the edge pixel counts, beyond that
/// nothing does.
struct Weight {
  int index;
  double weight;
};
std::vector<Weight> interval_weights(double low, double high, int n, double bleed) {
  std::vector<Weight> out;
  const double length = high - low;
  const auto add = [&](int i, double w) {
    if (w > 0) out.push_back({i, w / length});
  };
  add(0, std::min(high, 0.0) - std::max(low, -bleed));
  const int first = std::max(0, static_cast<int>(std::floor(low))), last = std::min(n - 1, static_cast<int>(std::ceil(high)) - 1);
  for (int i = first; i <= last; ++i) add(i, std::min(high, i + 1.0) - std::max(low, double(i)));
  add(n - 1, std::min(high, n + bleed) - std::max(low, double(n)));
  return out;
}
}  // namespace

double fit_tick(const LineBasics& b, double tick_s) {
  const double ticks = std::ceil(strip_length(b) / (b.belt_speed_m_s * tick_s) - kWholeTolerance);
  return strip_length(b) / (b.belt_speed_m_s * ticks);
}

HeadLayout strip_layout(const LineBasics& b, std::string name, std::string powder, double prong_pitch_m, double tick_s, double full_rate_kg_m2) {
  const double width = b.grid.nx * b.grid.pitch_m;
  const double prongs = width / prong_pitch_m, ticks = strip_length(b) / (b.belt_speed_m_s * tick_s);
  if (std::abs(prongs - std::round(prongs)) > kWholeTolerance * prongs)
    throw UsageError("dosing head '" + name + "': the bed, " + std::to_string(width * 1e3) + " mm wide, is not a whole number of prongs of " +
                     std::to_string(prong_pitch_m * 1e3) + " mm; set grid/width_module_mm to a multiple of the prong pitch");
  if (std::abs(ticks - std::round(ticks)) > kWholeTolerance * ticks)
    throw UsageError("dosing head '" + name + "': the strip is not a whole number of ticks; the nearest tick that fits is " +
                     std::to_string(fit_tick(b, tick_s) * 1e3) + " ms");
  return {std::move(name), std::move(powder), static_cast<int>(std::lround(prongs)), static_cast<int>(std::lround(ticks)), prong_pitch_m,
          tick_s,          full_rate_kg_m2};
}

std::vector<double> cell_fractions(const graphics::VeinPlan& plan, int channel, const LineBasics& b, const HeadLayout& layout) {
  const auto& f = plan.fraction;
  VENATO_EXPECTS(channel >= 0 && channel < f.channels);
  const double pixel = f.pitch_m * b.belt_from_design();  // plan pixel on the belt
  const double tick_length = layout.tick_s * b.belt_speed_m_s;
  const double rest = channel == plan.body_powder ? 1.0 : 0.0;  // lead-in and lead-out beyond the bleed are body
  std::vector<double> out(static_cast<std::size_t>(layout.prongs) * static_cast<std::size_t>(layout.ticks), 0.0);
  std::vector<std::vector<Weight>> columns;
  for (int p = 0; p < layout.prongs; ++p) {
    const double low = (p * layout.prong_pitch_m - b.trim_m) / pixel;
    columns.push_back(interval_weights(low, low + layout.prong_pitch_m / pixel, f.width, HUGE_VAL));
  }
  std::vector<double> row(static_cast<std::size_t>(f.width));
  for (int k = 0; k < layout.ticks; ++k) {
    const double low = (k * tick_length - b.grid.lead_m) / pixel;
    const auto rows = interval_weights(low, low + tick_length / pixel, f.height, b.trim_m / pixel);
    double inside = 0;
    std::fill(row.begin(), row.end(), 0.0);
    for (const auto& [j, w] : rows) {
      inside += w;
      for (int i = 0; i < f.width; ++i) row[static_cast<std::size_t>(i)] += w * static_cast<double>(f.at(i, j, channel));
    }
    for (int p = 0; p < layout.prongs; ++p) {
      double sum = rest * (1 - inside);
      for (const auto& [i, w] : columns[static_cast<std::size_t>(p)]) sum += w * row[static_cast<std::size_t>(i)];
      out[static_cast<std::size_t>(k) * static_cast<std::size_t>(layout.prongs) + static_cast<std::size_t>(p)] = std::clamp(sum, 0.0, 1.0);
    }
  }
  return out;
}

FeedHead plan_head(const graphics::VeinPlan& plan, int channel, const LineBasics& b, const HeadLayout& layout, const CommandRules& rules) {
  FeedHead head;
  head.name = layout.name;
  head.powder = layout.powder;
  head.prongs = layout.prongs;
  head.ticks = layout.ticks;
  head.prong_pitch_m = layout.prong_pitch_m;
  head.tick_s = layout.tick_s;
  head.belt_speed_m_s = b.belt_speed_m_s;
  head.full_rate_kg_m2 = layout.full_rate_kg_m2;
  head.duty = cell_fractions(plan, channel, b, layout);
  if (rules.mode == DutyMode::proportional) return head;
  const auto at = [&](int k, int p) -> double& {
    return head.duty[static_cast<std::size_t>(k) * static_cast<std::size_t>(head.prongs) + static_cast<std::size_t>(p)];
  };
  // A tick shorter than the minimum by rounding still counts as long enough.
  const int min_on = static_cast<int>(std::ceil(rules.min_on_s / layout.tick_s - kWholeTolerance)),
            min_off = static_cast<int>(std::ceil(rules.min_off_s / layout.tick_s - kWholeTolerance));
  std::vector<double> column(static_cast<std::size_t>(head.ticks));
  for (int p = 0; p < head.prongs; ++p) {
    for (int k = 0; k < head.ticks; ++k) column[static_cast<std::size_t>(k)] = at(k, p) > rules.on_threshold ? 1.0 : 0.0;
    enforce_min_times(column, min_on, min_off);
    for (int k = 0; k < head.ticks; ++k) at(k, p) = column[static_cast<std::size_t>(k)];
  }
  return head;
}

FeedHead complement_head(const std::vector<FeedHead>& heads, std::string name, std::string powder, double full_rate_kg_m2) {
  VENATO_EXPECTS(!heads.empty() && full_rate_kg_m2 > 0);
  FeedHead out = heads.front();
  out.name = std::move(name);
  out.powder = std::move(powder);
  out.full_rate_kg_m2 = full_rate_kg_m2;
  for (const auto& h : heads)
    if (h.prongs != out.prongs || h.ticks != out.ticks || h.prong_pitch_m != out.prong_pitch_m || h.tick_s != out.tick_s)
      throw UsageError("dosing heads '" + heads.front().name + "' and '" + h.name +
                       "' have different prongs or ticks; a body head can complement only heads that share them");
  for (std::size_t c = 0; c < out.duty.size(); ++c) {
    double laid = 0;
    for (const auto& h : heads) laid += h.duty[c] * h.full_rate_kg_m2;
    const double duty = 1 - laid / full_rate_kg_m2;
    if (duty < -1e-9)
      throw UsageError("dosing head '" + out.name + "': prong " + std::to_string(c % static_cast<std::size_t>(out.prongs)) + ", tick " +
                       std::to_string(c / static_cast<std::size_t>(out.prongs)) + " already gets " + std::to_string(laid) +
                       " kg/m2, more than the bed's " + std::to_string(full_rate_kg_m2) + " kg/m2; lower the vein share");
    out.duty[c] = std::max(0.0, duty);
  }
  return out;
}

FeedCommands plan_vein_and_body(const graphics::VeinPlan& plan, const LineBasics& basics, const std::string& vein_prefix, const std::string& body_prefix,
                                double prong_pitch_m, double tick_s, double min_on_s) {
  const std::string& vein = basics.powders[static_cast<std::size_t>(basics.vein_powder)].name;
  const std::string& body = basics.powders[static_cast<std::size_t>(basics.body_powder)].name;
  const HeadLayout layout = strip_layout(basics, vein_prefix + vein, vein, prong_pitch_m, fit_tick(basics, tick_s), basics.bed_mass_kg_m2);
  CommandRules rules;
  rules.min_on_s = rules.min_off_s = min_on_s;
  FeedCommands commands;
  commands.heads.push_back(plan_head(plan, basics.vein_powder, basics, layout, rules));
  commands.heads.push_back(complement_head({commands.heads[0]}, body_prefix + body, body, basics.bed_mass_kg_m2));
  return commands;
}
}  // namespace venato::line
