#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dem/case_reader_parts.h"

namespace venato::dem {
namespace {
constexpr std::size_t kMaxIntervals = 10000;
constexpr double kForever_s = 1e9;
constexpr double kFractionTolerance = 1e-6;  // six typed digits
// Ends of regions that are typed as the box's own corner may differ from it by one rounding.
constexpr double kSameCorner_m = 1e-12;
}  // namespace

std::string mm_text(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g mm", metres * 1e3);
  return text;
}

void read_vec3(ObjectReader& r, std::string_view key, Vec3& out, Range range, Opt<std::vector<double>> opt) {
  std::vector<double> v;
  r.numbers(key, v, range, 3, 3, opt);
  if (v.size() == 3) out = Vec3(v[0], v[1], v[2]);
}

void read_intervals(ObjectReader& r, std::string_view key, std::vector<Interval>& out, std::string_view help) {
  std::vector<double> flat;
  r.tuples(key, flat, 2, {0, kForever_s, "s"}, 0, kMaxIntervals, {.help = help, .fallback = std::vector<double>{}});
  out.clear();
  for (std::size_t k = 0; k + 1 < flat.size(); k += 2) {
    if (!(flat[k + 1] > flat[k])) r.issue(key, "interval " + std::to_string(k / 2) + " ends before it starts", "write [on, off] with off > on");
    if (!out.empty() && flat[k] < out.back().off_s)
      r.issue(key, "interval " + std::to_string(k / 2) + " starts before the one before it ends", "sort them and keep them apart");
    out.push_back({flat[k], flat[k + 1]});
  }
}

void check_unique(ObjectReader& r, std::string_view key, const std::vector<std::string>& names) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!names[k].empty() &&
        std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(k), names[k]) != names.begin() + static_cast<std::ptrdiff_t>(k))
      r.issue(key, "the name '" + names[k] + "' is used twice", "names must differ: files are named after them");
}

void read_box(ObjectReader& r, Case& c) {
  r.object("box", "the simulated region; a grain that leaves it in a direction that is not periodic is taken out and counted as lost",
           [&c](ObjectReader& o) {
             read_vec3(o, "low_mm", c.box.low, {-1e5, 1e5, "mm"}, {.help = "lower corner (x across, y along the belt, z up)"});
             read_vec3(o, "high_mm", c.box.high, {-1e5, 1e5, "mm"}, {.help = "upper corner"});
             o.boolean("periodic_x", c.box.periodic[0], {.help = "periodic across the belt", .fallback = false});
             o.boolean("periodic_y", c.box.periodic[1], {.help = "periodic along the belt", .fallback = false});
             o.boolean("periodic_z", c.box.periodic[2], {.help = "periodic upwards", .fallback = false});
             if (!((c.box.high - c.box.low).minCoeff() > 0))
               o.issue("high_mm", "the upper corner is not above the lower one in all three directions", "low < high");
           });
}

void read_region(ObjectReader& r, const Case& c, Vec3& low, Vec3& high, std::string_view what) {
  read_vec3(r, "low_mm", low, {-1e5, 1e5, "mm"}, {.help = "lower corner"});
  read_vec3(r, "high_mm", high, {-1e5, 1e5, "mm"}, {.help = "upper corner"});
  static constexpr const char* kAxis[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    if (!(high[k] > low[k])) r.issue("high_mm", std::string(what) + ": the upper corner is not above the lower one along " + kAxis[k], "low < high");
    if (low[k] < c.box.low[k] - kSameCorner_m || high[k] > c.box.high[k] + kSameCorner_m)
      r.issue("low_mm",
              std::string(what) + " reaches from " + mm_text(low[k]) + " to " + mm_text(high[k]) + " along " + kAxis[k] + ", the box from " +
                  mm_text(c.box.low[k]) + " to " + mm_text(c.box.high[k]),
              "keep it inside the box");
  }
}

void read_fractions(ObjectReader& r, const Case& c, std::vector<double>& fractions) {
  r.numbers("mass_fractions", fractions, {0, 1, ""}, 1, 16, {.help = "one per powder, in their order, sum 1"});
  if (fractions.empty()) return;
  if (fractions.size() != c.powders.size()) {
    r.issue("mass_fractions", std::to_string(fractions.size()) + " numbers for " + std::to_string(c.powders.size()) + " powders", "one per powder");
    return;
  }
  double sum = 0;
  for (double f : fractions) sum += f;
  if (!(std::abs(sum - 1) <= kFractionTolerance)) {
    r.issue("mass_fractions", "they sum to " + std::to_string(sum) + ", not to 1", "fractions by mass of all powders");
    return;
  }
  for (double& f : fractions) f /= sum;
}

double largest_grain(const Case& c) {
  double largest = 0;
  for (const Powder& p : c.powders) largest = std::max(largest, p.psd.upper_cut_m * c.coarse_graining);
  return largest;
}
}  // namespace venato::dem
