#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "dem/coarse_graining/openings.h"
#include "dem/rigs/discharge/rig.h"
#include "dem/rigs/support/statistics.h"

namespace venato::dem::rigs::discharge {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMm = 1e3, kG = 1e3;
constexpr double kRanDry = 0.6;  // the last eighth flows at less than that share of the others: running empty or blocking
constexpr std::size_t kCurvePoints = 40;
const std::string kBlockError = "8 time blocks", kFitError = "weighted fit of the openings' block errors";

std::string percent(double share) { return std::to_string(static_cast<int>(std::lround(100 * share))) + " %"; }
}  // namespace

RigResult measure(const Config& config, const Case& c, const CaseResult& r) {
  RigResult out;
  const auto found = std::find_if(c.counters.begin(), c.counters.end(), [&](const Counter& k) { return k.name == config.counter; });
  const auto& records = r.records.at(static_cast<std::size_t>(found - c.counters.begin()));
  const double gravity = c.gravity_m_s2.norm(), grain = mean_volume_grain_m(c);
  double density = kNan;
  if (config.has_bulk && config.bulk_plan < r.snapshots.size() && !r.snapshots[config.bulk_plan].empty())
    density = bulk_density(r.snapshots[config.bulk_plan].front(), c, config.bulk_low, config.bulk_high);
  const double constant = config.slot ? kSlotConstant : kHoleConstant;

  std::vector<Flow> flows;
  RigTable table{"discharge",
                 {{"size_mm", "mm", "diameter of the hole or width of the slot", {}},
                  {"flow_g_s", "g/s", "mass flow", {}},
                  {"standard_error_g_s", "g/s", "of the flow, from 8 time blocks", {}},
                  {"beverloo_g_s", "g/s", "Beverloo's law with k = 1.4 and C = 0.58 (hole) or 1.03 (slot); NaN without a bulk region", {}}}};
  for (const Window& w : config.openings) {
    const Flow flow = flow_in_window(records, w.from_s + config.settle_s, w.to_s);
    flows.push_back(flow);
    const std::string size = short_number(w.size_m * kMm);
    const double law = beverloo_kg_s(config, w.size_m, density, gravity, grain, constant, kEmptyAnnulus);
    out.kpis.push_back({"flow_at_" + size + "_mm_g_s", flow.mean_kg_s * kG, flow.standard_error_kg_s * kG, "g/s",
                        std::string("mass flow through the ") + (config.slot ? "slot" : "hole") + " of " + size + " mm", kBlockError});
    out.kpis.push_back({"flow_at_" + size + "_mm_over_beverloo", flow.mean_kg_s / law, flow.standard_error_kg_s / law, "1",
                        "flow over Beverloo's law with k = 1.4 and the coarse grains", kBlockError});
    const double row[] = {w.size_m * kMm, flow.mean_kg_s * kG, flow.standard_error_kg_s * kG, law * kG};
    for (std::size_t k = 0; k < 4; ++k) table.columns[k].values.push_back(row[k]);
    if (std::isnan(flow.mean_kg_s))
      out.warnings.push_back("discharge: fewer than 20 grains went through the opening of " + size + " mm (blocked, empty or closed): no flow");
    else if (flow.last_block_share < kRanDry)
      out.warnings.push_back("discharge: at the end of its window the opening of " + size + " mm passed only " + percent(flow.last_block_share) +
                             " of its flow before (running empty or blocking); shorten the window or fill more");
  }
  const BeverlooFit fit = fit_beverloo(config, flows, density, gravity, grain);
  out.kpis.push_back({"bulk_density_kg_m3", density, kNan, "kg/m3", "bulk density just before the first opening", ""});
  out.kpis.push_back({"mean_grain_mm", grain * kMm, kNan, "mm", "diameter of the mean (coarse) grain volume: d of Beverloo's law", ""});
  if (config.openings.size() >= 3) {
    out.kpis.push_back({"beverloo_constant", fit.constant, fit.constant_error, "1", "C of Beverloo's law through the openings", kFitError});
    out.kpis.push_back({"beverloo_k", fit.empty_m / grain, fit.empty_error_m / grain, "1", "k of Beverloo's law through the openings", kFitError});
    out.kpis.push_back({"beverloo_r2", fit.r2, kNan, "1", "share of the variance that the law explains", ""});
  }

  Plot plot;
  plot.title = c.name + ": discharge flow";
  plot.x_label = config.slot ? "slot width [mm]" : "hole diameter [mm]";
  plot.y_label = "mass flow [g/s]";
  Series points{"measured", {}, {}, {}, {}, SeriesStyle::points, ""}, law{"Beverloo, fitted", {}, {}, {}, {}, SeriesStyle::line, ""},
      usual{"Beverloo, usual constants", {}, {}, {}, {}, SeriesStyle::line, ""};
  double largest = 0;
  for (std::size_t k = 0; k < flows.size(); ++k) {
    const double f = flows[k].mean_kg_s * kG, e = flows[k].standard_error_kg_s * kG;
    points.x.push_back(config.openings[k].size_m * kMm), points.y.push_back(f), points.y_low.push_back(f - e), points.y_high.push_back(f + e);
    largest = std::max(largest, config.openings[k].size_m);
  }
  plot.series.push_back(points);
  for (std::size_t k = 0; k <= kCurvePoints; ++k) {
    const double size = 1.1 * largest * static_cast<double>(k) / kCurvePoints;
    if (!std::isnan(fit.constant)) {
      law.x.push_back(size * kMm);
      law.y.push_back(kG * beverloo_kg_s(config, size, density, gravity, fit.empty_m, fit.constant, 1));
    }
    if (!std::isnan(density)) {
      usual.x.push_back(size * kMm);
      usual.y.push_back(kG * beverloo_kg_s(config, size, density, gravity, grain, constant, kEmptyAnnulus));
    }
  }
  if (!law.x.empty()) plot.series.push_back(law);
  if (!usual.x.empty()) plot.series.push_back(usual);
  out.plots.push_back({"discharge", plot});
  out.tables.push_back(table);
  return out;
}
}  // namespace venato::dem::rigs::discharge
