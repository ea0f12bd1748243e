/// Checkpoint of a running case: engine state, measurement state, fingerprint of the case. Binary, for the same build on the same kind of machine; a
/// file appears only when complete.
#include <fstream>
#include <span>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "dem/run_case_state.h"
#include "dem/simulation/archive.h"

namespace venato::dem {
namespace {
constexpr std::uint64_t kMagic = 0x3244504b43454456ull;  // "VDECKPD2"

void exchange_text(ByteWriter& a, const std::string& s) {
  a.value(static_cast<std::uint64_t>(s.size()));
  for (const char c : s) a.value(c);
}

/// Measurement state; one function for both directions.
template <class Archive, class Run>
void exchange(Archive& a, Run& r) {
  a.list(r.births), a.list(r.rains), a.list(r.waiting);
  for (auto& s : r.seen) a.list(s);
  a.list(r.counter_mass_kg), a.list(r.impulse_before);
  a.value(r.sampled_at_s), a.value(r.samples), a.list(r.frames), a.list(r.vtk_times_s), a.value(r.pictures), a.value(r.delayed_hand_overs);
  a.value(r.field_frames);
  if (r.fields) r.fields->exchange(a);
  auto& o = r.result;
  for (auto& list : o.records) a.list(list);
  auto& s = o.series;
  a.list(s.time_s), a.list(s.grain_count), a.list(s.mass_kg), a.list(s.kinetic_energy_j), a.list(s.mean_contacts), a.list(s.max_speed_m_s),
      a.list(s.top_z_m);
  for (auto& list : s.counter_mass_kg) a.list(list);
  for (auto& list : s.wall_force_n) a.list(list);
  a.value(o.mass_put_in_kg), a.value(o.mass_removed_kg), a.value(o.mass_lost_box_kg), a.value(o.particle_steps);
}
template <class Archive, class S>
void exchange_snapshot(Archive& a, S& s) {
  a.value(s.time_s), a.list(s.id), a.list(s.position_m), a.list(s.velocity_m_s), a.list(s.radius_m), a.list(s.species);
}

void add_shape(ByteWriter& w, const WallShape& shape) {
  w.value(static_cast<std::uint64_t>(shape.index()));
  if (const auto* p = std::get_if<PlaneShape>(&shape)) w.value(p->point), w.value(p->normal);
  if (const auto* c = std::get_if<CylinderShape>(&shape))
    w.value(c->base), w.value(c->axis), w.value(c->length_m), w.value(c->radius_m), w.value(c->inside);
  if (const auto* m = std::get_if<MeshShape>(&shape)) w.list(m->triangles);
}
void add_motion(ByteWriter& w, const WallMotion& m) {
  w.value(m.velocity_m_s), w.list(m.translate_when), w.list(m.track), w.value(m.rotation_centre), w.value(m.rotation_rad_s),
      w.value(m.vibration_amplitude_m);
  w.value(m.vibration_hz), w.value(m.vibration_phase_rad), w.list(m.vibrate_when), w.value(m.surface_velocity_m_s);
}
}  // namespace

std::uint64_t case_fingerprint(const Case& c) {
  ByteWriter w;
  for (int a = 0; a < 3; ++a) w.value(c.box.low[a]), w.value(c.box.high[a]), w.value(c.box.periodic[a]);
  w.value(c.gravity_m_s2);
  for (const Material& m : c.materials.materials) w.value(m.density_kg_m3), w.value(m.young_modulus_pa), w.value(m.poisson_ratio);
  w.list(c.materials.pairs);
  for (const Powder& p : c.powders) w.value(p.psd), w.value(p.material);
  w.value(c.coarse_graining), w.value(static_cast<int>(c.law)), w.value(c.eepa), w.value(c.expected_max_speed_m_s), w.value(c.rayleigh_fraction);
  w.value(c.hertz_fraction), w.value(c.time_step_s), w.value(c.duration_s), w.value(c.seed);
  for (const Wall& v : c.walls) add_shape(w, v.shape), add_motion(w, v.motion), w.value(v.material), w.value(v.present);
  for (const Fill& f : c.fills) w.value(f.low), w.value(f.high), w.list(f.powder_mass_fractions), w.value(f.mass_kg), w.value(f.velocity_m_s), w.value(f.solid_fraction);
  for (const Rain& r : c.rains)
    exchange_text(w, r.name), w.value(r.low), w.value(r.high), w.list(r.powder_mass_fractions), w.value(r.mass_rate_kg_s),
        w.value(r.resting_speed_m_s), w.list(r.when), w.value(r.velocity_m_s), w.value(r.level_z_m);
  for (const GrainRecord& g : c.handed_over)
    w.value(g.time_s), w.value(g.position_m), w.value(g.velocity_m_s), w.value(g.spin_rad_s), w.value(g.diameter_m), w.value(g.species);
  for (const Counter& k : c.counters)
    w.value(k.axis), w.value(k.position_m), w.value(k.sign), w.value(k.window_low), w.value(k.window_high), w.value(k.remove), w.value(k.first_only);
  w.value(c.series.every_s), w.list(c.snapshots), w.value(c.vtk_every_s), w.value(c.pictures.every_s);
  if (c.fields)
    w.value(c.fields->width_m), w.value(c.fields->cell_m), w.value(c.fields->from_s), w.value(c.fields->to_s), w.value(c.fields->every_s),
        w.value(c.fields->diffusivity);
  std::uint64_t h = 14695981039346656037ull;
  for (const std::uint8_t b : w.bytes) h = (h ^ b) * 1099511628211ull;
  return h;
}

void save_checkpoint(const CaseRun& run, const std::filesystem::path& file) {
  ByteWriter w;
  w.value(kMagic), w.value(case_fingerprint(run.c)), w.value(run.result.time_step_s);
  w.list(run.sim.save_state());
  exchange(w, run);
  for (const auto& plan : run.result.snapshots) {
    w.value(static_cast<std::uint64_t>(plan.size()));
    for (const Snapshot& s : plan) exchange_snapshot(w, s);
  }
  write_atomically(file, [&](const std::filesystem::path& partial) {
    std::ofstream out(partial, std::ios::binary);
    out.write(reinterpret_cast<const char*>(w.bytes.data()), static_cast<std::streamsize>(w.bytes.size()));
    out.close();
    if (!out) throw WorkError("cannot write the checkpoint " + partial.string());
  });
}

void load_checkpoint(CaseRun& run, const std::filesystem::path& file) {
  const std::string bytes = read_file(file, std::uintmax_t{1} << 36);
  try {
    ByteReader r(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
    std::uint64_t magic = 0, fingerprint = 0;
    double dt = 0;
    r.value(magic), r.value(fingerprint), r.value(dt);
    if (magic != kMagic) throw WorkError("not a DEM checkpoint of this version");
    if (fingerprint != case_fingerprint(run.c) || dt != run.result.time_step_s)
      throw UsageError("checkpoint " + file.string() + " belongs to another case than '" + run.c.name + "'; remove it to start anew");
    std::vector<std::uint8_t> state;
    r.list(state);
    run.sim.load_state(state);
    exchange(r, run);
    for (auto& plan : run.result.snapshots) {
      std::uint64_t n = 0;
      r.value(n);
      for (std::uint64_t k = 0; k < n; ++k) exchange_snapshot(r, plan.emplace_back());
    }
    if (!r.done()) throw WorkError("longer than expected");
  } catch (const WorkError& e) {
    throw WorkError("checkpoint " + file.string() + " is damaged (" + e.what() + "); remove it to start anew");
  }
}
}  // namespace venato::dem
