#include "sync/score/zones.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include "base/error.h"
#include "base/rng.h"
#include "sync/score/centreline.h"
namespace venato::sync {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kClass_m = 1e-5;

/// What a zone adds to any total of zones.
struct Sums {
  std::vector<double> length;  ///< [class of |distance|] matched length
  double print = 0, matched = 0, body = 0, found = 0, signed_sum = 0;
  void add(const Sums& o) {
    for (std::size_t k = 0; k < length.size(); ++k) length[k] += o.length[k];
    print += o.print, matched += o.matched, body += o.body, found += o.found, signed_sum += o.signed_sum;
  }
  double quantile(double q) const {
    double want = q * matched;
    if (!(matched > 0)) return kNone;
    for (std::size_t k = 0; k < length.size(); ++k)
      if ((want -= length[k]) <= 0) return (static_cast<double>(k) + 0.5) * kClass_m;
    return static_cast<double>(length.size()) * kClass_m;
  }
};

Verdict judge(const ZoneScore& z, const ZoneConfig& c) {
  const Tolerance& t = c.tolerance;
  if (z.print_length_m + z.body_length_m < c.least_length_m) return Verdict::no_evidence;
  // NaN: the zone has no veins of that side, which nothing can be held against; their partners may lie just across its border.
  if (z.matched < t.least_matched || z.found < t.least_matched) return Verdict::low_match;
  if (std::isnan(z.median_m)) return Verdict::no_evidence;
  if (z.median_m <= t.good_median_m && z.p95_m <= t.good_p95_m) return Verdict::good;
  return z.p95_m <= t.fair_p95_m ? Verdict::fair : Verdict::bad;
}

void fill(ZoneScore& z, const Sums& s, const ZoneConfig& c) {
  z.print_length_m = s.print, z.body_length_m = s.body;
  z.matched = s.print > 0 ? s.matched / s.print : kNone, z.found = s.body > 0 ? s.found / s.body : kNone;
  z.median_m = s.quantile(0.5), z.p95_m = s.quantile(0.95), z.offset_m = s.matched > 0 ? s.signed_sum / s.matched : kNone;
  z.verdict = judge(z, c);
}

Interval middle_95(std::vector<double> v) {
  if (v.size() < 2) return {kNone, kNone};
  std::sort(v.begin(), v.end());
  const auto at = [&](double q) { return v[static_cast<std::size_t>(std::lround(q * static_cast<double>(v.size() - 1)))]; };
  return {at(0.025), at(0.975)};
}

void bootstrap(SlabScore& out, const std::vector<Sums>& sums, const ZoneConfig& c) {
  std::vector<const Sums*> usable;
  for (const Sums& s : sums)
    if (s.matched > 0) usable.push_back(&s);
  std::vector<double> median, p95, matched;
  if (usable.size() >= 2) {
    const std::size_t n = static_cast<std::size_t>(c.resamples);
    median.resize(n), p95.resize(n), matched.resize(n);
    for (std::size_t r = 0; r < n; ++r) {
      Rng rng(c.seed, stream_id("sync/score/zones/bootstrap"), r);
      Sums total{std::vector<double>(usable.front()->length.size())};
      for (std::size_t k = 0; k < usable.size(); ++k) total.add(*usable[rng.below(usable.size())]);
      median[r] = total.quantile(0.5), p95[r] = total.quantile(0.95), matched[r] = total.matched / total.print;
    }
  }
  out.median = middle_95(std::move(median)), out.p95 = middle_95(std::move(p95)), out.matched = middle_95(std::move(matched));
}
}  // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return "good";
    case Verdict::fair:
      return "fair";
    case Verdict::low_match:
      return "low_match";
    case Verdict::bad:
      return "bad";
    case Verdict::no_evidence:
      break;
  }
  return "no_evidence";
}

SlabScore score_zones(const graphics::Raster8& body, const graphics::Raster8& print, const ScoreConfig& config, const ZoneConfig& c) {
  check_masks(body, print);
  if (!(c.zone_m > 0) || c.resamples < 1) throw UsageError("score: zones and the number of resamples must be positive");
  SlabScore out;
  const double width = body.width_m(), height = body.height_m();
  out.columns = std::max(1, static_cast<int>(std::lround(width / c.zone_m))),
  out.rows = std::max(1, static_cast<int>(std::lround(height / c.zone_m)));
  const double wide = width / out.columns, high = height / out.rows;
  const std::size_t classes = static_cast<std::size_t>(std::ceil(config.search_m / kClass_m)) + 1;
  std::vector<Sums> sums(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows), Sums{std::vector<double>(classes)});
  const auto zone_at = [&](const Point& p) -> Sums& {
    const int i = std::clamp(static_cast<int>(p.x() / wide), 0, out.columns - 1), j = std::clamp(static_cast<int>(p.y() / high), 0, out.rows - 1);
    return sums[static_cast<std::size_t>(j) * static_cast<std::size_t>(out.columns) + static_cast<std::size_t>(i)];
  };
  // As in score_masks(): lines thinner than min_width_m are not scored, but they are partners.
  for (const NormalResidual& r : normal_residuals(centre_links(print, config.min_width_m), centre_links(body, 0), config)) {
    Sums& s = zone_at(r.at_m);
    s.print += r.length_m;
    if (!r.matched) continue;
    s.matched += r.length_m, s.signed_sum += r.length_m * r.signed_distance_m;
    s.length[std::min(classes - 1, static_cast<std::size_t>(std::abs(r.signed_distance_m) / kClass_m))] += r.length_m;
  }
  for (const NormalResidual& r : normal_residuals(centre_links(body, config.min_width_m), centre_links(print, 0), config)) {
    Sums& s = zone_at(r.at_m);
    s.body += r.length_m, s.found += r.matched ? r.length_m : 0;
  }
  Sums total{std::vector<double>(classes)};
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double column = static_cast<double>(k % static_cast<std::size_t>(out.columns)),
                 row = static_cast<double>(k / static_cast<std::size_t>(out.columns));
    ZoneScore z;
    z.x_m = column * wide, z.y_m = row * high, z.width_m = wide, z.height_m = high;
    fill(z, sums[k], c);
    out.zones.push_back(z);
    total.add(sums[k]);
  }
  out.whole.width_m = width, out.whole.height_m = height;
  fill(out.whole, total, c);
  bootstrap(out, sums, c);
  return out;
}
}  // namespace venato::sync
