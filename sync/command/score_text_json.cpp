#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sync/command/score_text.h"

namespace venato::sync {
namespace {

using Json = nlohmann::ordered_json;

/// Six significant digits: micrometres of a millimetre score, without the noise of the last bits.
Json number(double v) {
  if (!std::isfinite(v)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return std::stod(text);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Json contract(const std::optional<Metrics>& m) {
  const auto value = [&](double Metrics::*member, double unit = 1) { return number(m ? (*m).*member / unit : kNone); };
  return {{"centreline_error_mm", {{"median", value(&Metrics::centreline_median_m, 1e-3)}, {"p95", value(&Metrics::centreline_p95_m, 1e-3)}}},
          {"matched_length", value(&Metrics::matched_length)},
          {"boundary_f1",
           {{"1mm", value(&Metrics::boundary_f1_1mm)}, {"2mm", value(&Metrics::boundary_f1_2mm)}, {"3mm", value(&Metrics::boundary_f1_3mm)}}},
          {"dice", value(&Metrics::dice)}};
}

Json more(const std::optional<Metrics>& m) {
  if (!m) return nullptr;
  const auto share = [](double part, double whole) { return number(whole > 0 ? 100 * part / whole : kNone); };
  return {{"centreline_offset_mm", number(m->centreline_offset_m * 1e3)},
          {"centreline_max_mm", number(m->centreline_max_m * 1e3)},
          {"matched_length_mm", number(m->matched_length * m->print_length_m * 1e3)},
          {"missing_length_mm", number(m->missing_length_m * 1e3)},
          {"missing_length_percent", share(m->missing_length_m, m->body_length_m)},
          {"extra_length_mm", number(m->extra_length_m * 1e3)},
          {"extra_length_percent", share(m->extra_length_m, m->print_length_m)},
          {"area_error_percent", number(m->area_error * 100)},
          {"body_width_mm", number(m->body_width_m * 1e3)},
          {"print_width_mm", number(m->print_width_m * 1e3)},
          {"width_error_mm", number((m->print_width_m - m->body_width_m) * 1e3)},
          {"direction_coherence", number(m->direction_coherence)},
          {"iou", number(m->iou)},
          {"cl_dice", number(m->cl_dice)},
          {"hd95_mm", number(m->hd95_m * 1e3)},
          {"assd_mm", number(m->assd_m * 1e3)}};
}

Json edges(const std::optional<EdgeWidths>& e) {
  if (!e) return nullptr;
  return {{"median", number(e->median_m * 1e3)}, {"p95", number(e->p95_m * 1e3)}, {"measured_share", number(e->measured)}};
}

Json seen(const std::vector<Visibility>& list) {
  if (list.empty()) return nullptr;
  Json out = Json::array();
  for (const Visibility& v : list)
    out.push_back({{"distance_m", number(v.distance_m)},
                   {"delta_e2000_mean", number(v.delta_e_mean)},
                   {"delta_e2000_p95", number(v.delta_e_p95)},
                   {"area_over_1_percent", number(100 * v.area_over_1)},
                   {"area_over_2_percent", number(100 * v.area_over_2)},
                   {"visible_length_mm", number(v.visible_length_m() * 1e3)},
                   {"visible_length_percent", number(v.print_length_m > 0 ? 100 * v.visible_length_m() / v.print_length_m : kNone)},
                   {"displaced_visible_length_mm", number(v.displaced_length_m * 1e3)},
                   {"extra_visible_length_mm", number(v.extra_length_m * 1e3)},
                   {"missing_visible_length_mm", number(v.missing_length_m * 1e3)}});
  return out;
}
Json visibility_json(const std::optional<VisibilityReport>& v) {
  if (!v) return nullptr;
  return {
      {"definition",
       "S-CIELAB difference of two pictures in the graphic's mean vein and ground colours: veins where the body has them, veins where the print "
       "lies. "
       "Mean and P95 over what either vein covers, areas of the whole slab; visible length: of the print's centre line, where the difference across "
       "the vein is noticeable and the shift is more than 1 arcmin or the body has no vein there; missing: of body veins without print"},
      {"vein_srgb", v->colours.vein},
      {"ground_srgb", v->colours.ground},
      {"vein_to_ground_delta_e2000", number(v->colours.delta_e)},
      {"noticeable_delta_e2000", number(v->noticeable_delta_e)},
      {"before", seen(v->before)},
      {"after", seen(v->after)}};
}

Json interval(const Interval& i, double unit) { return Json::array({number(i.low / unit), number(i.high / unit)}); }

Json verdict(const ScoreReport& report) {
  const Tolerance& t = report.tolerance;
  Json out = {{"tolerance",
               {{"good_median_mm", number(t.good_median_m * 1e3)},
                {"good_p95_mm", number(t.good_p95_m * 1e3)},
                {"fair_p95_mm", number(t.fair_p95_m * 1e3)},
                {"least_matched_length", number(t.least_matched)}}}};
  out["slab"] = report.zones ? name(report.zones->whole.verdict) : "not_registered";
  if (!report.zones) return out;
  Json count = Json::object();
  for (const Verdict v : {Verdict::good, Verdict::fair, Verdict::low_match, Verdict::bad, Verdict::no_evidence})
    count[name(v)] = std::count_if(report.zones->zones.begin(), report.zones->zones.end(), [&](const ZoneScore& z) { return z.verdict == v; });
  out["zones"] = count;
  out["interval_95"] = {{"median_mm", interval(report.zones->median, 1e-3)},
                        {"p95_mm", interval(report.zones->p95, 1e-3)},
                        {"matched_length", interval(report.zones->matched, 1)}};
  return out;
}

Json zone(const ZoneScore& z) {
  return {{"x_mm", number(z.x_m * 1e3)},
          {"y_mm", number(z.y_m * 1e3)},
          {"width_mm", number(z.width_m * 1e3)},
          {"height_mm", number(z.height_m * 1e3)},
          {"verdict", name(z.verdict)},
          {"median_mm", number(z.median_m * 1e3)},
          {"p95_mm", number(z.p95_m * 1e3)},
          {"offset_mm", number(z.offset_m * 1e3)},
          {"matched_length", number(z.matched)},
          {"body_length_found", number(z.found)},
          {"print_length_mm", number(z.print_length_m * 1e3)},
          {"body_length_mm", number(z.body_length_m * 1e3)}};
}

Json camera(const CameraReport& c) {
  const bool residual = c.view.marks > 4;  // four marks are met exactly
  return {{"marks", c.view.marks},
          {"mark_residual_mm",
           {{"median", number(residual ? c.view.mark_median_m * 1e3 : kNone)}, {"max", number(residual ? c.view.mark_max_m * 1e3 : kNone)}}},
          {"camera_mm_per_px", {{"finest", number(c.view.finest_m_px * 1e3)}, {"coarsest", number(c.view.coarsest_m_px * 1e3)}}},
          {"seen_share", number(c.visible)}};
}

}  // namespace

std::string score_json_text(const ScoreReport& report, const Registration& registration) {
  Json out;
  out["before"] = contract(report.before);
  out["after"] = contract(report.after);
  out["best_reachable"] = contract(report.best_reachable);
  out["registration"] = {{"success", registration.success}, {"reason", registration.reason}, {"confidence", number(registration.confidence)}};
  if (registration.success) {
    const Lying l = how_it_lies(registration.pose_only);
    out["registration"]["graphic_lies"] = {{"turn_deg", l.turn_deg},
                                           {"mirrored", l.mirrored},
                                           {"rotation_deg", number(l.rotation_rad * 180 / M_PI)},
                                           {"slab_corner_in_graphic_mm", {number(l.corner_m.x() * 1e3), number(l.corner_m.y() * 1e3)}}};
  }
  if (registration.success) {
    const SlabStretch& s = registration.stretch;
    out["registration"]["slab_stretch"] = {
        {"along_belt_percent", number(s.along * 100)},
        {"across_belt_percent", number(s.across * 100)},
        {"shear_mm_per_m", number(s.shear * 1e3)},
        {"definition",
         "the slab against the graphic at the given mm per pixel, mean over the slab; positive: the slab is longer; along the belt = y of "
         "the slab"}};
  }
  out["verdict"] = verdict(report);
  out["before_definition"] = report.before_definition;
  out["after_definition"] = report.after_definition;
  out["best_reachable_definition"] = report.best_reachable_definition;
  Json& details = out["details"];
  details["evidence"] = report.evidence;
  if (report.camera) details["camera"] = camera(*report.camera);
  details["pose_only"] = report.pose_only ? contract(report.pose_only) : Json(nullptr);
  details["before"] = more(report.before);
  details["after"] = more(report.after);
  details["best_reachable"] = more(report.best_reachable);
  details["edge_width_10_90_mm"] = {{"body", edges(report.body_edge)}, {"print", edges(report.print_edge)}};
  details["visibility"] = visibility_json(report.visibility);
  details["score_zones"] = Json::array();
  if (report.zones)
    for (const ZoneScore& z : report.zones->zones) details["score_zones"].push_back(zone(z));
  details["internal_residual_mm"] = number(registration.internal_residual_m * 1e3);
  details["gates"] = Json::array();
  for (const Gate& gate : registration.gates)
    details["gates"].push_back(
        {{"name", gate.name}, {"value", number(gate.value)}, {"limit", number(gate.limit)}, {"passed", gate.passed}, {"meaning", gate.meaning}});
  details["zones"] = Json::array();
  for (const ZoneConfidence& zone : registration.zones)
    details["zones"].push_back({{"x_mm", number(zone.x_m * 1e3)},
                                {"y_mm", number(zone.y_m * 1e3)},
                                {"width_mm", number(zone.width_m * 1e3)},
                                {"height_mm", number(zone.height_m * 1e3)},
                                {"blocks", zone.blocks},
                                {"residual_mm", number(zone.residual_m * 1e3)},
                                {"sigma_mm", number(zone.sigma_m * 1e3)},
                                {"usable", zone.usable}});
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace venato::sync
