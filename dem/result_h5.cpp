#include <functional>

#include "base/h5/h5_file.h"
#include "base/version.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/case_outputs/labels.h"
#include "dem/fields/continuum_h5.h"
#include "dem/run_case.h"

// One table in code of what a DEM result holds; the layout is
//   /series/*, /counters/<name>/*, /snapshots/<plan>/*, /fields/* (with Case::fields), /final/*, /balance/*, /names/*, /kpi/*, /rig/<table>/*.
namespace venato::dem {
namespace {
constexpr int kFormatVersion = 1;
const char* const kFrame = "dem";  // x across, y along the belt, z up; origin as in the case

using Dims = std::vector<std::uint64_t>;

template <class Item>
std::vector<double> column(const std::vector<Item>& items, const std::function<double(const Item&)>& get) {
  std::vector<double> out;
  out.reserve(items.size());
  for (const Item& item : items) out.push_back(get(item));
  return out;
}
template <class Item>
std::vector<double> vectors(const std::vector<Item>& items, const std::function<const Vec3&(const Item&)>& get) {
  std::vector<double> out;
  out.reserve(3 * items.size());
  for (const Item& item : items)
    for (int k = 0; k < 3; ++k) out.push_back(get(item)[k]);
  return out;
}
template <class Item, class T>
std::vector<T> integers(const std::vector<Item>& items, const std::function<T(const Item&)>& get) {
  std::vector<T> out;
  out.reserve(items.size());
  for (const Item& item : items) out.push_back(get(item));
  return out;
}

void write_counter(H5Writer& file, const std::string& group, const std::vector<CounterRecord>& records) {
  using R = CounterRecord;
  const Dims n{records.size()}, n3{records.size(), 3};
  const auto number = [&](const char* name, const char* units, const char* what, const std::function<double(const R&)>& get) {
    file.dataset(group + name, column<R>(records, get), n, {units, "crossing", kFrame, what});
  };
  const auto vector = [&](const char* name, const char* units, const char* what, const std::function<const Vec3&(const R&)>& get) {
    file.dataset(group + name, vectors<R>(records, get), n3, {units, "crossing,xyz", kFrame, what});
  };
  number("time_s", "s", "time of the crossing, interpolated inside the step", [](const R& r) { return r.time_s; });
  vector("position_m", "m", "place of the crossing, periodic directions unwrapped", [](const R& r) -> const Vec3& { return r.position_m; });
  vector("velocity_m_s", "m/s", "velocity at the crossing", [](const R& r) -> const Vec3& { return r.velocity_m_s; });
  vector("spin_rad_s", "rad/s", "spin at the crossing", [](const R& r) -> const Vec3& { return r.spin_rad_s; });
  vector("birth_position_m", "m", "where the grain was put in", [](const R& r) -> const Vec3& { return r.birth_position_m; });
  number("birth_time_s", "s", "when the grain was put in", [](const R& r) { return r.birth_time_s; });
  number("mass_kg", "kg", "mass of the grain", [](const R& r) { return r.mass_kg; });
  number("diameter_m", "m", "diameter of the (coarse-grained) grain", [](const R& r) { return r.diameter_m; });
  file.dataset(group + "id", integers<R, std::int64_t>(records, [](const R& r) { return r.id; }), n, {"1", "crossing", "none", "id of the grain"});
  file.dataset(group + "species", integers<R, std::int32_t>(records, [](const R& r) { return static_cast<std::int32_t>(r.species); }), n,
               {"1", "crossing", "none", "index of its powder in /names/powders"});
}

void write_series(H5Writer& file, const TimeSeries& s) {
  const Dims n{s.time_s.size()};
  const auto series = [&](const char* name, const std::vector<double>& data, const char* units, const char* what) {
    file.dataset(std::string("/series/") + name, data, n, {units, "sample", kFrame, what});
  };
  series("time_s", s.time_s, "s", "time of the sample");
  series("grain_count", s.grain_count, "1", "grains in the box");
  series("mass_kg", s.mass_kg, "kg", "their mass");
  series("kinetic_energy_j", s.kinetic_energy_j, "J", "their kinetic energy, translation and spin");
  series("mean_contacts", s.mean_contacts, "1", "mean number of contacts per grain");
  series("max_speed_m_s", s.max_speed_m_s, "m/s", "largest speed");
  series("top_z_m", s.top_z_m, "m", "height of the highest grain centre");
  std::vector<double> mass;
  for (const auto& row : s.counter_mass_kg) mass.insert(mass.end(), row.begin(), row.end());
  file.dataset("/series/counter_mass_kg", mass, {s.counter_mass_kg.size(), s.time_s.size()},
               {"kg", "counter,sample", "none", "mass that has crossed each counter so far"});
  std::vector<double> force;
  for (const auto& row : s.wall_force_n)
    for (const Vec3& f : row) force.insert(force.end(), {f.x(), f.y(), f.z()});
  file.dataset("/series/wall_force_n", force, {s.wall_force_n.size(), s.time_s.size(), 3},
               {"N", "wall,sample,xyz", kFrame, "force of the grains on each wall, mean over the sampling interval"});
}

void write_snapshots(H5Writer& file, const std::string& group, const std::vector<Snapshot>& frames) {
  std::vector<double> time, position, velocity;
  std::vector<std::int64_t> start{0}, id;
  std::vector<float> radius;
  std::vector<std::int32_t> species;
  for (const Snapshot& f : frames) {
    time.push_back(f.time_s);
    id.insert(id.end(), f.id.begin(), f.id.end());
    radius.insert(radius.end(), f.radius_m.begin(), f.radius_m.end());
    species.insert(species.end(), f.species.begin(), f.species.end());
    for (const Vec3& x : f.position_m) position.insert(position.end(), {x.x(), x.y(), x.z()});
    for (const Vec3& v : f.velocity_m_s) velocity.insert(velocity.end(), {v.x(), v.y(), v.z()});
    start.push_back(static_cast<std::int64_t>(id.size()));
  }
  const Dims n{id.size()}, n3{id.size(), 3};
  file.dataset(group + "time_s", time, {time.size()}, {"s", "frame", "none", "time of the frame"});
  file.dataset(group + "frame_start", start, {start.size()}, {"1", "frame", "none", "frame f holds entries [frame_start[f], frame_start[f + 1])"});
  file.dataset(group + "id", id, n, {"1", "entry", "none", "id of the grain, rising within a frame"});
  file.dataset(group + "position_m", position, n3, {"m", "entry,xyz", kFrame, "centre, periodic directions unwrapped"});
  file.dataset(group + "velocity_m_s", velocity, n3, {"m/s", "entry,xyz", kFrame, "velocity"});
  file.dataset(group + "radius_m", radius, n, {"m", "entry", "none", "radius of the (coarse-grained) grain"});
  file.dataset(group + "species", species, n, {"1", "entry", "none", "index of its powder in /names/powders"});
}

void write_final(H5Writer& file, const std::vector<GrainRecord>& grains) {
  using G = GrainRecord;
  const Dims n{grains.size()}, n3{grains.size(), 3};
  file.dataset("/final/id", integers<G, std::int64_t>(grains, [](const G& g) { return g.id; }), n, {"1", "grain", "none", "id of the grain"});
  file.dataset("/final/species", integers<G, std::int32_t>(grains, [](const G& g) { return static_cast<std::int32_t>(g.species); }), n,
               {"1", "grain", "none", "index of its powder in /names/powders"});
  file.dataset("/final/diameter_m", column<G>(grains, [](const G& g) { return g.diameter_m; }), n,
               {"m", "grain", "none", "diameter (coarse-grained)"});
  file.dataset("/final/time_s", column<G>(grains, [](const G& g) { return g.time_s; }), n, {"s", "grain", "none", "time of this state"});
  file.dataset("/final/position_m", vectors<G>(grains, [](const G& g) -> const Vec3& { return g.position_m; }), n3,
               {"m", "grain,xyz", kFrame, "centre"});
  file.dataset("/final/velocity_m_s", vectors<G>(grains, [](const G& g) -> const Vec3& { return g.velocity_m_s; }), n3,
               {"m/s", "grain,xyz", kFrame, "velocity"});
  file.dataset("/final/spin_rad_s", vectors<G>(grains, [](const G& g) -> const Vec3& { return g.spin_rad_s; }), n3,
               {"rad/s", "grain,xyz", kFrame, "spin"});
}

void write_balance(H5Writer& file, const CaseResult& r) {
  const auto scalar = [&](const char* name, double value, const char* units, const char* what) {
    file.dataset(std::string("/balance/") + name, std::vector<double>{value}, {}, {units, "", "none", what});
  };
  scalar("mass_put_in_kg", r.mass_put_in_kg, "kg", "mass of all grains put in");
  scalar("mass_removed_kg", r.mass_removed_kg, "kg", "mass taken out by counters");
  scalar("mass_lost_box_kg", r.mass_lost_box_kg, "kg", "mass of grains that left the box");
  scalar("mass_left_kg", r.mass_left_kg, "kg", "mass in the box at the end");
  scalar("time_step_s", r.time_step_s, "s", "time step");
  scalar("steps", static_cast<double>(r.steps), "1", "steps done");
  scalar("particle_steps", r.particle_steps, "1", "sum over the steps of the grains present");
  scalar("max_speed_seen_m_s", r.max_speed_seen_m_s, "m/s", "largest speed of any grain at any step");
  scalar("max_overlap_seen", r.max_overlap_seen, "1", "largest overlap over the radius of the smaller grain");
  file.dataset("/balance/rain_starved_kg", r.rain_starved_kg, {r.rain_starved_kg.size()},
               {"kg", "rain", "none", "mass that did not fit into each rain's region"});
}

template <class T>
std::vector<std::string> labels(const Case& c, const std::vector<T>& items, std::string (*label)(const Case&, std::size_t)) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < items.size(); ++k) out.push_back(label(c, k));
  return out;
}
}  // namespace

namespace {
void write_report(H5Writer& file, const CaseReport& report) {
  const auto texts = [&](const char* name, std::string Kpi::*member, const char* what) {
    std::vector<std::string> all;
    for (const Kpi& k : report.kpis) all.push_back(k.*member);
    file.strings(std::string("/kpi/") + name, all, {"1", "kpi", "none", what});
  };
  texts("name", &Kpi::name, "name of each number"), texts("unit", &Kpi::unit, "its unit"), texts("description", &Kpi::description, "what it is");
  texts("error_from", &Kpi::error_from, "what its standard error was made from");
  const Dims n{report.kpis.size()};
  file.dataset("/kpi/value", column<Kpi>(report.kpis, [](const Kpi& k) { return k.value; }), n, {"see /kpi/unit", "kpi", "none", "measured numbers"});
  file.dataset("/kpi/standard_error", column<Kpi>(report.kpis, [](const Kpi& k) { return k.standard_error; }), n,
               {"see /kpi/unit", "kpi", "none", "standard error, NaN = not known"});
  for (const RigTable& table : report.tables)
    for (const RigTable::Column& k : table.columns)
      file.dataset("/rig/" + table.name + "/" + k.name, k.values, {k.values.size()}, {k.unit, "row", "none", k.description});
}
}  // namespace

void write_case_result(const std::filesystem::path& path, const Case& c, const CaseResult& r, const CaseReport& report) {
  H5Writer file(path, "venato-dem-result", kFormatVersion);
  file.attribute("/", "code_version", version_string());
  file.attribute("/", "case", c.name);
  file.attribute("/", "seed", std::to_string(c.seed));  // text: 64 bits do not fit a double
  file.attribute("/", "coarse_graining", c.coarse_graining);
  file.strings("/names/counters", labels(c, c.counters, counter_label), {"1", "counter", "none", "names of the counters"});
  file.strings("/names/walls", labels(c, c.walls, wall_label), {"1", "wall", "none", "names of the walls"});
  file.strings("/names/powders", labels(c, c.powders, powder_label), {"1", "powder", "none", "names of the powders"});
  file.strings("/names/warnings", r.warnings, {"1", "warning", "none", "what the run warned about"});
  write_series(file, r.series);
  for (std::size_t k = 0; k < r.records.size(); ++k) write_counter(file, "/counters/" + counter_label(c, k) + "/", r.records[k]);
  for (std::size_t k = 0; k < r.snapshots.size(); ++k) write_snapshots(file, "/snapshots/" + std::to_string(k) + "/", r.snapshots[k]);
  if (r.fields) write_fields(file, "/fields/", *r.fields);
  write_final(file, r.final_state);
  write_balance(file, r);
  write_report(file, report);
  file.close();
}
}  // namespace venato::dem
