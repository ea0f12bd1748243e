#pragma once
/// Soft-sphere DEM engine: grains, walls, contacts and their integration in time. SI units; frame as in dem/case.h.
///
/// What:     velocity Verlet (kick, drift, kick); forces see the half-step velocities. Contact laws of design.md 7 (dem/contact/*).
/// Bits:     the same calls give the same bytes for any number of threads, whenever the neighbour list happens to be rebuilt.
/// Validity: overlaps small against radii; dt of choose_time_step(). Size ratios up to 20:1 are correct, up to 8:1 fast.
/// Errors:   UsageError for bad input (radius, material, periodic box shorter than two cutoffs …); the engine itself never stops a run:
///           run_case() watches speeds.
/// Source:   reference/verification.md (formulas, variants, numbers), design.md 7.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "base/vec3.h"
#include "dem/case.h"
#include "dem/material.h"

namespace venato::dem {

using GrainId = std::int64_t;  ///< given in order of insertion from 0, never reused

struct SimulationSetup {
  MaterialTable materials;
  LawKind law = LawKind::hertz_mindlin_epsd;
  EepaParameters eepa;
  Box box;  ///< only its periodic directions matter here; run_case() removes what leaves it elsewhere
  Vec3 gravity_m_s2 = Vec3(0, 0, -9.80665);
  double time_step_s = 0;  ///< > 0
  int threads = 1;
  double skin_m = 0;                    ///< of the Verlet list; 0 = chosen from the grain sizes. Never changes results
  bool track_energy = false;            ///< fill EnergyBook's dissipated_* and wall_work (some % slower)
  bool brute_force_neighbours = false;  ///< every pair instead of the grid: for tests
};

struct GrainInput {
  Vec3 position_m = Vec3::Zero(), velocity_m_s = Vec3::Zero(), spin_rad_s = Vec3::Zero();
  double radius_m = 0;  ///< > 0
  int species = 0, material = 0;
  bool frozen = false;  ///< never accelerated (keeps its velocity and spin); counts as infinitely heavy in contacts
  double mass_kg = 0;   ///< 0 = 4/3 pi R^3 density; inertia is 2/5 m R^2 of a solid sphere in both cases
};

struct GrainState {
  GrainId id;
  Vec3 position_m;                ///< unwrapped across periodic faces
  Vec3 velocity_m_s, spin_rad_s;  ///< at the full step
  Vec3 force_n, torque_n_m;       ///< total incl. gravity
  double radius_m, mass_kg;
  int species, material;
  bool frozen;
};

/// One grain-grain contact seen from grain i (i < j) or one grain-wall contact (j = -1).
struct ContactState {
  GrainId i, j;
  int wall;  ///< -1 for grain-grain
  double overlap_m;
  Vec3 normal;               ///< unit, from i towards j (or towards the wall)
  double normal_force_n;     ///< > 0 pushes apart
  Vec3 tangential_spring_n;  ///< spring part of the tangential force on i, co-rotating with the contact
  Vec3 tangential_force_n;   ///< on i: spring + damping after the Coulomb cap
  Vec3 rolling_spring_n_m;   ///< spring part of the rolling torque on i
  Vec3 rolling_torque_n_m;   ///< on i: spring + damping after its cap
  Vec3 force_n, torque_n_m;  ///< total contact force and torque on i
};

struct WallLoad {
  Vec3 force_n = Vec3::Zero(), torque_n_m = Vec3::Zero();
};  ///< by the grains on the wall; torque about rotation_centre

/// Energies at the current full step. kinetic + potential + elastic_* + dissipated_* - wall_work is constant up to the integration error.
struct EnergyBook {
  double kinetic_translation_j = 0, kinetic_rotation_j = 0;
  double potential_j = 0;  ///< -m g . x, unwrapped positions
  double elastic_normal_j = 0, elastic_tangential_j = 0, elastic_rolling_j = 0;
  double dissipated_normal_j = 0;  ///< normal damping, F_n >= 0 clamp, plastic work of EEPA
  double dissipated_tangential_damping_j = 0;
  double dissipated_sliding_j = 0;  ///< Coulomb slip and the loss of rescaling / stiffening of the tangential spring
  double dissipated_rolling_j = 0;  ///< rolling damping and full mobilisation
  double wall_work_j = 0;           ///< done by moving walls on the grains
  double kinetic_j() const { return kinetic_translation_j + kinetic_rotation_j; }
  double elastic_j() const { return elastic_normal_j + elastic_tangential_j + elastic_rolling_j; }
  double dissipated_j() const { return dissipated_normal_j + dissipated_tangential_damping_j + dissipated_sliding_j + dissipated_rolling_j; }
};

/// A grain centre crossed a counter plane during the last steps (all crossings; first_only / remove are the caller's).
struct Crossing {
  int counter;
  double time_s, fraction;  ///< linear inside the step; fraction 0 = start of the step
  GrainId id;
  Vec3 position_m;                ///< interpolated, unwrapped
  Vec3 velocity_m_s, spin_rad_s;  ///< half-step values
};

/// Since the last reset_statistics(). What belongs to forces is that of the last step whose forces were asked for or needed: reading grains or
/// contacts brings it up to date.
struct StepStatistics {
  std::int64_t steps = 0, list_builds = 0;
  double pair_count = 0, contact_count = 0;  ///< of the last step
  double max_speed_m_s = 0;
  GrainId fastest = -1;
  double max_overlap = 0;  ///< overlap / radius of the smaller grain
  /// Wall clock by phase: making lists; finding which listed pairs touch; their forces; summing them, kicks and drift; walls.
  double seconds_list = 0, seconds_scan = 0, seconds_contact = 0, seconds_integrate = 0, seconds_walls = 0;
};

class Simulation {
 public:
  /// \throws UsageError on material tables that are incomplete or outside physical limits, dt <= 0, bad boxes.
  explicit Simulation(const SimulationSetup& setup);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // ---- set up and change; allowed at any time between steps ----------------------------------------------------------------
  GrainId add_grain(const GrainInput& grain);
  /// As add_grain for grains that touch nothing yet: skips the re-evaluation of all forces before the next step.
  GrainId insert_free_grain(const GrainInput& grain);
  void remove_grain(GrainId id);
  void remove_grains(std::span<const GrainId> ids);
  int add_wall(const Wall& wall);  ///< returns its index
  void set_wall_motion(int wall, const WallMotion& motion);
  /// Sets velocity and spin of a grain (kicks, frozen grains that are moved kinematically).
  void set_velocity(GrainId id, const Vec3& velocity_m_s, const Vec3& spin_rad_s);
  void set_position(GrainId id, const Vec3& position_m);  ///< histories of its contacts stay
  void set_gravity(const Vec3& gravity_m_s2);
  void set_counters(const std::vector<Counter>& counters);

  // ---- run -----------------------------------------------------------------------------------------------------------------
  void step(std::int64_t n = 1);
  /// Forces and contacts of the present positions without moving anything or advancing histories (e.g. a frozen overlap).
  void evaluate_forces();
  double time_s() const;
  std::int64_t step_number() const;
  double time_step_s() const;
  int threads() const;

  // ---- read ----------------------------------------------------------------------------------------------------------------
  std::size_t grain_count() const;
  bool has_grain(GrainId id) const;
  GrainState grain(GrainId id) const;
  std::vector<GrainId> grain_ids() const;  ///< ascending
  std::vector<GrainState> grains() const;  ///< ascending ids
  /// Touching contacts, grain-grain sorted by (i, j), then grain-wall sorted by (i, wall).
  std::vector<ContactState> contacts() const;
  std::size_t wall_count() const;
  WallLoad wall_load(int wall) const;     ///< of the last step
  Vec3 wall_impulse_n_s(int wall) const;  ///< sum of force * dt since the start
  Vec3 wall_offset_m(int wall) const;     ///< displacement of the wall from its drawn place (translation part)
  double mean_contacts() const;           ///< per grain, walls counted once, of the last step
  bool wall_present(int wall) const;
  Vec3 wall_point_m(int wall, const Vec3& drawn_point_m) const;  ///< where a point of the wall as drawn is now
  EnergyBook energy() const;
  std::vector<Crossing> take_crossings();  ///< sorted by (time, id, counter); empties the buffer
  /// No grain overlaps the sphere (walls are not looked at).
  bool is_free(const Vec3& position_m, double radius_m) const;
  /// Signed gap of a sphere to the nearest present wall [m]; +infinity without walls. Exact where it matters: gaps to meshes beyond about
  /// 0.3 radius may be reported larger.
  double wall_gap_m(const Vec3& position_m, double radius_m) const;
  /// Highest centre of the grains that rest on something inside the columns low.xy … high.xy [m]; -infinity when there are none. Resting = touching
  /// and slower than `resting_speed_m_s`: grains that bounce on their way down do not count.
  double bed_top_m(const Vec3& low, const Vec3& high, double resting_speed_m_s) const;
  /// Ids of grains whose centre is outside the box in a non-periodic direction (after the last step), ascending.
  std::vector<GrainId> grains_outside(const Box& box) const;
  /// Order-independent 64-bit hash of the complete dynamic state (grains, histories, time): equal hashes = equal bytes.
  std::uint64_t state_hash() const;
  const StepStatistics& statistics() const;
  void reset_statistics();

  // ---- checkpoint ----------------------------------------------------------------------------------------------------------
  std::vector<std::uint8_t> save_state() const;          ///< everything that step() depends on, except setup, walls and counters
  void load_state(std::span<const std::uint8_t> bytes);  ///< into a Simulation made with the same setup, walls and counters

  struct Impl;  ///< the engine itself (dem/simulation/impl.h)

 private:
  std::unique_ptr<Impl> impl_;
};
}  // namespace venato::dem
