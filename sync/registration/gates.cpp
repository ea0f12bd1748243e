#include "sync/registration/gates.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include "sync/registration/posterior.h"
namespace venato::sync {
namespace {
// Limits of registration_print.md 1.5 where it gives them.
constexpr double kPeakRatioSure = 1.6, kBlockNcc = 0.75, kZoneShare = 0.30, kHeldOut_m = 0.0003;
// Own additions, set between the worst true and the best wrong pair of the trials (see the table in this folder's test).
constexpr double kMatchedShare = 0.4, kPeakRatioFloor = 1.05, kGlobalNcc = 0.4;
// Powder that spreads a vein by 10 mm cannot be placed to 0.3 mm although the pair is right (0.3-0.4 mm measured, true error 0.4-0.8 mm). Up to this
// limit the residual passes if the peak ratio is sure and the shares are far from every wrong pair (80 of them: matched share <= 0.11, whole NCC <=
// 0.33, residual >= 0.7 mm; 48 true pairs: >= 0.89, >= 0.88, <= 0.14 mm).
constexpr double kHeldOutSpread_m = 0.0008, kGlobalNccSure = 0.6;
// Brings |error| / sigma on the veins of 48 true pairs to median 0.87, P95 2.3 (a 2-D Gaussian has 0.83 and 1.73).
constexpr double kSigmaCalibration = 1.4;
constexpr double kMinBending_mm2 = 1e-4;  // a pure affine map bends nothing: keeps the division finite
constexpr double kZone_m = 0.200, kSigmaPitch_m = 0.010;
constexpr double kUsableSigma_m = 0.002;  // domain.md 2.1: P95 of a good slab
constexpr double kGoodBlockNcc = 0.6;
constexpr double kChiSquareMedian2 = 1.386294361;  // median of chi^2 with 2 degrees of freedom = 2 ln 2

double quantile(std::vector<double> v, double q) {
  if (v.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(v.begin(), v.end());
  const double at = q * static_cast<double>(v.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  return k + 1 < v.size() ? v[k] + (at - static_cast<double>(k)) * (v[k + 1] - v[k]) : v.back();
}
std::string text(const char* format, double a, double b) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

struct Judged {
  std::vector<double> ncc, across_m, weighted, held_out_m;
};

Judged measure(const NonrigidResult& fit) {
  Judged j;
  for (std::size_t k = 0; k < fit.blocks.size(); ++k) {
    j.ncc.push_back(fit.blocks[k].ncc);
    j.across_m.push_back(residual_across_m(fit.observations[k], fit.map.u));
    j.weighted.push_back(weighted_square(fit.observations[k], fit.map.u));
    if (fit.held_out[k]) j.held_out_m.push_back(residual_across_m(fit.observations[k], fit.held_out_field));
  }
  return j;
}

void fill_zones(const NonrigidResult& fit, const Judged& judged, double width_m, double height_m, Registration& out) {
  const int columns = std::max(1, static_cast<int>(std::lround(width_m / kZone_m))),
            rows = std::max(1, static_cast<int>(std::lround(height_m / kZone_m)));
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      ZoneConfidence z{c * width_m / columns, r * height_m / rows, width_m / columns, height_m / rows, 0, 0, 0, false};
      const auto inside = [&](double x, double y) { return x >= z.x_m && x < z.x_m + z.width_m && y >= z.y_m && y < z.y_m + z.height_m; };
      std::vector<double> residuals, sigmas;
      for (std::size_t k = 0; k < fit.blocks.size(); ++k)
        if (fit.blocks[k].ncc >= kGoodBlockNcc && inside(fit.blocks[k].at_m.x(), fit.blocks[k].at_m.y())) residuals.push_back(judged.across_m[k]);
      for (int j = 0; j < out.sigma_m.height; ++j)
        for (int i = 0; i < out.sigma_m.width; ++i)
          if (inside((i + 0.5) * kSigmaPitch_m, (j + 0.5) * kSigmaPitch_m)) sigmas.push_back(static_cast<double>(out.sigma_m.at(i, j)));
      z.blocks = static_cast<int>(residuals.size());
      z.residual_m = quantile(residuals, 0.5);
      z.sigma_m = quantile(sigmas, 0.5);
      z.usable = z.blocks > 0 && z.sigma_m <= kUsableSigma_m;
      out.zones.push_back(z);
    }
}

/// 0 at `bad`, 1 at `good`, linear between.
double grade(double value, double bad, double good) { return std::clamp((value - bad) / (good - bad), 0.0, 1.0); }
}  // namespace

void fail(Registration& out, Gate gate, std::string reason) {
  gate.passed = false;
  out.success = false;
  out.confidence = 0;
  out.reason = gate.name + ": " + std::move(reason);
  out.gates.push_back(std::move(gate));
}

void judge(const Features& green, const PoseSearch& search, const RefinedPose& pose, const NonrigidResult& fit, const Feature& print_signed,
           const RegistrationConfig& config, const BSplineField& prior_field, int threads, Registration& out) {
  const double width = green.signed_evidence.value.width_m(), height = green.signed_evidence.value.height_m();
  out.gates.push_back({"T1", pose.ecc, 0, true, "correlation after the affine refinement"});
  const Judged judged = measure(fit);
  // Neighbouring blocks share pixels: each pixel speaks in overlap_factor blocks, so the independent evidence is that much less.
  const double overlap_factor = std::pow(2 * fit.last_level.half_m / fit.last_level.step_m, 2);
  const double unit_variance =
      std::max(1e-6, quantile(judged.weighted, 0.5) / kChiSquareMedian2) * overlap_factor * kSigmaCalibration * kSigmaCalibration;
  if (!fit.blocks.empty()) {
    // Where no block speaks the error is what the displacement may do there, and how much it bends is measured: the field found so far. The fit's
    // own stiffness alone, scaled with the residuals, promised least error in the gaps of the sharpest pictures. It stays the upper limit, because
    // a field found from few blocks is smoother than the truth.
    const double bending = std::max(kMinBending_mm2, bending_variance(fit.map.u, fit.reference)),
                 stiffness = std::min(fit.lambda, unit_variance / bending);
    out.sigma_m =
        sigma_map(fit.map.u, normal_matrix(fit.observations, fit.weight, fit.map.u, stiffness), unit_variance, width, height, kSigmaPitch_m, threads);
  }
  fill_zones(fit, judged, width, height, out);
  out.internal_residual_m = quantile(judged.held_out_m, 0.5);

  const double ncc = judged.ncc.empty() ? 0 : quantile(judged.ncc, 0.5);
  const double matched = fit.textured > 0
                             ? static_cast<double>(std::count_if(fit.blocks.begin(), fit.blocks.end(),
                                                                 [](const BlockMatch& b) { return !b.faded && b.ncc >= kGoodBlockNcc; })) /
                                   fit.textured
                             : 0;
  const auto zones_with_blocks = std::count_if(out.zones.begin(), out.zones.end(), [](const ZoneConfidence& z) { return z.blocks > 0; });
  const double zone_share = static_cast<double>(zones_with_blocks) / static_cast<double>(out.zones.size());
  const Feature& slab = green.signed_evidence;
  const double whole = masked_ncc(slab, warp_to_green(print_signed, fit.map, slab.value.width, slab.value.height, threads), threads);
  double farthest = 0;
  for (int j = 0; j * kSigmaPitch_m <= height; ++j)
    for (int i = 0; i * kSigmaPitch_m <= width; ++i) {
      const Point p(i * kSigmaPitch_m, j * kSigmaPitch_m);
      farthest = std::max(farthest, (fit.map.u.displacement(p) - prior_field.displacement(p)).norm());
    }
  const double ratio = std::max(search.gradient_peak_ratio, search.signed_peak_ratio);

  const bool t3 = ncc >= kBlockNcc, t3_zones = zone_share >= kZoneShare, t3_share = matched >= kMatchedShare, t3_whole = whole >= kGlobalNcc;
  const bool sure = ratio >= kPeakRatioSure && t3 && t3_share && t3_zones && whole >= kGlobalNccSure;
  const double t4_limit = sure ? kHeldOutSpread_m : kHeldOut_m;
  const bool t4 = out.internal_residual_m <= t4_limit, t5 = farthest <= config.displacement_limit_m;  // false for NaN
  const bool t2 = ratio >= kPeakRatioFloor;
  const struct {
    Gate gate;
    std::string reason;
  } all[] = {
      {{"T3", ncc, kBlockNcc, t3, "median block NCC"}, text("median block NCC %.2f < %.2f: the pictures do not show the same veins", ncc, kBlockNcc)},
      {{"T3 share", matched, kMatchedShare, t3_share, "share of the slab's vein blocks that found their partner"},
       text("only %.0f %% of the slab's vein blocks found a partner in the graphic (need %.0f %%): the pictures do not show the same veins",
            100 * matched, 100 * kMatchedShare)},
      {{"T3 zones", zone_share, kZoneShare, t3_zones, "share of the 200 mm zones with matched blocks"},
       text("matched blocks lie in only %.0f %% of the 200 mm zones (need %.0f %%)", 100 * zone_share, 100 * kZoneShare)},
      {{"T3 whole", whole, kGlobalNcc, t3_whole, "NCC of the whole overlap after registration"},
       text("NCC of the whole overlap after registration is %.2f < %.2f: veins are missing on one side", whole, kGlobalNcc)},
      {{"T4", out.internal_residual_m * 1e3, t4_limit * 1e3, t4, "median residual of held-out blocks across the vein [mm]"},
       text("held-out blocks disagree by %.2f mm in the median (limit %.2f mm)", out.internal_residual_m * 1e3, t4_limit * 1e3)},
      {{"T5", farthest * 1e3, config.displacement_limit_m * 1e3, t5, "largest displacement against the prior [mm]"},
       text("the veins would have to move by %.0f mm (limit %.0f mm)", farthest * 1e3, config.displacement_limit_m * 1e3)},
      {{"T2", ratio, kPeakRatioSure, t2, "best / next best place more than 60 mm away (below the limit: only with T3, T4, T5)"},
       text("two places of the graphic fit equally well (peak ratio %.2f, need %.2f): which portion is meant cannot be told", ratio,
            kPeakRatioFloor)}};
  out.success = true;
  for (const auto& entry : all) {
    out.gates.push_back(entry.gate);
    if (entry.gate.passed || !out.success) continue;
    out.success = false;
    out.reason = entry.gate.name + ": " + entry.reason;
  }
  // Geometric mean of how far each gate is from its limit: one weak test lowers it, a failed one makes it 0.
  const double grades = grade(ratio, 1, kPeakRatioSure) * grade(ncc, 0.6, 0.9) * grade(matched, 0.25, 0.8) * grade(zone_share, 0, 0.6) *
                        grade(whole, 0.1, 0.7) * grade(-out.internal_residual_m, -1.2 * kHeldOutSpread_m, -0.5 * kHeldOut_m);
  out.confidence = out.success ? std::pow(grades, 1.0 / 6) : 0;
}
}  // namespace venato::sync
