#include "dem/case_reader.h"

#include <algorithm>
#include <cmath>

#include "dem/case_reader_parts.h"
#include "dem/material_reader.h"
#include "dem/rigs/rig_api.h"

namespace venato::dem {
namespace {
constexpr std::size_t kMaxPowders = 16, kMaxWalls = 500, kMaxSources = 200, kMaxCounters = 200, kMaxPlans = 100;

void read_format(ObjectReader& r) {
  int format = 0, version = 0;
  r.choice("format", format, {{"venato-dem", 1}}, {.help = "what kind of file this is"});
  r.integer("version", version, {1, 1, ""}, {.help = "version of this format"});
}

void read_law(ObjectReader& r, Case& c) {
  r.object("contact", "contact law between grains, and between grains and walls", [&c](ObjectReader& o) {
    o.pick(
        "law", "contact law",
        {{"hertz_mindlin_epsd", "free-flowing powder: Hertz-Mindlin with elastic-plastic rolling resistance",
          [&c](ObjectReader&) { c.law = LawKind::hertz_mindlin_epsd; }},
         {"eepa", "pressing: edinburgh elasto-plastic adhesion", [&c](ObjectReader& b) {
            c.law = LawKind::eepa;
            b.number("stiffness_ratio_k2_k1", c.eepa.stiffness_ratio_k2_k1, {1, 1000, ""}, {.help = "unloading over loading stiffness"});
            b.number("adhesion_ratio_kadh_k1", c.eepa.adhesion_ratio_kadh_k1, {0, 1000, ""}, {.help = "adhesion over loading stiffness"});
            b.number("exponent", c.eepa.exponent, {1, 1.5, ""}, {.help = "1 linear, 1.5 Hertzian loading", .fallback = 1.5});
            if (c.eepa.exponent != 1 && c.eepa.exponent != 1.5)
              b.issue("exponent", "is neither 1 nor 1.5", "1 = linear, 1.5 = Hertzian; the law is only made for these two");
            b.number("constant_force_mn", c.eepa.constant_force_n, {-1000, 0, "mN"}, {.help = "f0: constant pull-off force (<= 0)", .fallback = 0.0});
          }}});
  });
}

void read_time(ObjectReader& r, Case& c) {
  r.number("duration_s", c.duration_s, {1e-6, 1e4, "s"}, {.help = "simulated time"});
  r.number("expected_max_speed_m_s", c.expected_max_speed_m_s, {1e-3, 100, "m/s"},
           {.help = "fastest relative speed of grains expected (v_max of the Hertz bound); a grain much faster stops the run with an error"});
  r.object(
      "time_step", "how the step is chosen",
      [&c](ObjectReader& o) {
        o.number("rayleigh_fraction", c.rayleigh_fraction, {1e-3, 0.5, ""}, {.help = "part of the smallest grain's Rayleigh time", .fallback = 0.20});
        o.number("hertz_fraction", c.hertz_fraction, {1e-3, 0.3, ""}, {.help = "part of the shortest Hertz contact", .fallback = 0.10});
        o.number("fixed_us", c.time_step_s, {0, 1000, "us"}, {.help = "0 = the smaller of the two bounds", .fallback = 0.0});
      },
      false);
}

template <class T, class Read>
void read_list(ObjectReader& r, std::string_view key, std::string_view help, std::size_t min_count, std::size_t max_count, std::vector<T>& out,
               const Read& read) {
  out.clear();
  if (min_count == 0 && !r.has(key) && !r.describing()) return;
  r.objects(key, help, min_count, max_count, [&](ObjectReader& item, std::size_t) {
    T value;
    read(item, value);
    out.push_back(std::move(value));
  });
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) names.push_back(item.name);
  return names;
}

void read_powders(ObjectReader& r, Case& c) {
  read_materials(r, c.materials);
  read_list(r, "powders", "powders; grains carry the index of theirs", 1, kMaxPowders, c.powders,
            [&c](ObjectReader& item, Powder& powder) { read_powder(item, c.materials, powder); });
  check_unique(r, "powders", names_of(c.powders));
  r.number("coarse_graining", c.coarse_graining, {1, 20, ""}, {.help = "grain diameters are the powder's times this", .fallback = 1.0});
}

void read_pictures(ObjectReader& r, Case& c) {
  r.optional_object("pictures", "pictures of the particles (PNG) while the case runs", [&c](ObjectReader& o) {
    PicturePlan& p = c.pictures;
    o.number("every_s", p.every_s, {1e-6, 1e4, "s"}, {.help = "interval of the pictures, from the start; one more at the end"});
    o.choice("view", p.view,
             {{"front", PictureView::front}, {"side", PictureView::side}, {"top", PictureView::top}, {"oblique", PictureView::oblique}},
             {.help = "front: x right, z up; side: y right, z up; top: x right, y up", .fallback = "front"});
    o.choice("colour", p.colour, {{"powder", PictureColour::powder}, {"speed", PictureColour::speed}, {"size", PictureColour::size}},
             {.help = "what the colour of a grain shows", .fallback = "powder"});
    o.number("full_speed_m_s", p.full_speed_m_s, {0, 100, "m/s"}, {.help = "end of the speed scale; 0 = expected_max_speed_m_s", .fallback = 0.0});
    o.integer("width_px", p.width_px, {100, 4000, "px"}, {.help = "width of the picture", .fallback = 900});
    p.has_region = o.optional_object("region", "part of the box that is shown; grains outside are left out, so this also cuts",
                                     [&](ObjectReader& q) { read_region(q, c, p.low, p.high, "the region"); });
  });
}

/// What the warning about coarse grains needs to know: it cannot be seen in the walls.
void read_narrow_places(ObjectReader& r, Case& c) {
  double opening = 0;
  bool slot = false;
  r.number("smallest_opening_mm", opening, {0, 1e4, "mm"},
           {.help = "smallest hole, slot or gap that grains must pass: warns when coarse grains are too large for it; 0 = none", .fallback = 0.0});
  r.choice("smallest_opening_form", slot, {{"hole", false}, {"slot", true}}, {.help = "round, or long (slots and gaps)", .fallback = "slot"});
  r.number("layer_thickness_mm", c.layer_thickness_m, {0, 1e4, "mm"},
           {.help = "thinnest layer that matters: warns when it has fewer than 10 coarse grains; 0 = none", .fallback = 0.0});
  if (opening > 0) c.openings.push_back({"smallest opening", opening, slot});
}

void check_periodic(ObjectReader& r, const Case& c) {
  static constexpr const char* kAxis[] = {"x", "y", "z"};
  const double needed = 2 * largest_grain(c);  // below that a grain meets its own image, or the same neighbour from both sides
  for (int k = 0; k < 3; ++k)
    if (c.box.periodic[k] && c.box.high[k] - c.box.low[k] < needed)
      r.issue("box",
              std::string("the periodic length along ") + kAxis[k] + " is " + mm_text(c.box.high[k] - c.box.low[k]) +
                  ", less than two of the largest grains (" + mm_text(needed) + ")",
              "widen the box or lower coarse_graining");
}
}  // namespace

void read_case(ObjectReader& r, Case& c) {
  read_format(r);
  r.name("name", c.name, {.help = "name of the case"});
  r.seed("seed", c.seed, {.help = "seed of all random numbers; same seed, same bytes"});
  read_box(r, c);
  read_vec3(r, "gravity_m_s2", c.gravity_m_s2, {-100, 100, "m/s2"}, {.help = "gravity", .fallback = std::vector<double>{0, 0, -9.80665}});
  read_powders(r, c);
  read_law(r, c);
  read_time(r, c);
  check_periodic(r, c);
  read_list(r, "walls", "walls, with their motions", 0, kMaxWalls, c.walls, [&c](ObjectReader& item, Wall& wall) { read_wall(item, c, wall); });
  check_unique(r, "walls", names_of(c.walls));
  read_list(r, "fills", "blocks of grains placed at the start", 0, kMaxSources, c.fills,
            [&c](ObjectReader& item, Fill& fill) { read_fill(item, c, fill); });
  read_list(r, "rains", "regions where grains appear at a mass rate", 0, kMaxSources, c.rains,
            [&c](ObjectReader& item, Rain& rain) { read_rain(item, c, rain); });
  check_unique(r, "rains", names_of(c.rains));
  if (c.fills.empty() && c.rains.empty()) r.issue("", "neither fills nor rains: there would be no grains", "add a fill or a rain");
  read_list(r, "counters", "planes that record the grains which cross them", 0, kMaxCounters, c.counters,
            [&c](ObjectReader& item, Counter& counter) { read_counter(item, c, counter); });
  check_unique(r, "counters", names_of(c.counters));
  r.object(
      "series", "time series of masses, energy, wall forces",
      [&c](ObjectReader& o) {
        o.number("every_s", c.series.every_s, {1e-6, 1000, "s"}, {.help = "sampling interval", .fallback = 0.005});
      },
      false);
  read_list(r, "snapshots", "windows in which all positions are kept", 0, kMaxPlans, c.snapshots,
            [&c](ObjectReader& item, SnapshotPlan& plan) { read_snapshots(item, c, plan); });
  read_fields(r, c);
  r.object(
      "vtk", "ParaView files",
      [&c](ObjectReader& o) {
        o.number("every_s", c.vtk_every_s, {0, 1000, "s"}, {.help = "interval of the files; 0 = none", .fallback = 0.0});
      },
      false);
  read_pictures(r, c);
  read_narrow_places(r, c);
  read_rig(r, c);
}

Case load_case(const std::filesystem::path& file, const std::vector<Override>& overrides, ReadOutcome* outcome) {
  Case c;
  ReadOutcome read = read_config_file(file, overrides, [&c](ObjectReader& r) { read_case(r, c); });
  if (outcome != nullptr) *outcome = read;
  read.throw_if_bad();
  return c;
}
}  // namespace venato::dem
