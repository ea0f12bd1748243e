#pragma once
/// Inside of Simulation. One function per phase of the step, each in its own file; see step.cpp for the order.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "dem/contact/eepa/law.h"
#include "dem/contact/hertz_mindlin/law.h"
#include "dem/contact/liggghts_hertz/law.h"
#include "dem/neighbours/cell_grid.h"
#include "dem/neighbours/pair_list.h"
#include "dem/neighbours/reach_plan.h"
#include "dem/simulation/stray_watch.h"
#include "dem/simulation/exact_sum.h"
#include "dem/simulation/pair_lanes.h"
#include "dem/simulation/simulation.h"
#include "dem/walls/wall_model.h"

namespace venato::dem {

struct GrainCard {  ///< cold data
  GrainId id;
  double mass;
  std::int32_t species, material;
  std::array<std::int32_t, 3> image;  ///< unwrapped = position + image * box length
  std::uint8_t frozen, removed;
};

/// Materials pairs -> law, for grains and walls alike.
template <class L>
struct LawTable {
  std::vector<L> law;
  std::size_t materials = 0;
  const L& of(std::int32_t a, std::int32_t b) const { return law[static_cast<std::size_t>(a) * materials + static_cast<std::size_t>(b)]; }
};
using AnyLawTable = std::variant<LawTable<HertzMindlin>, LawTable<Eepa>, LawTable<LiggghtsHertz>>;

struct WallContact {
  std::int32_t wall;
  ContactHistory history;
  Trio normal;  ///< from the grain into the wall, of the last step
  double overlap;
  ContactForce force;
  Trio on_grain, torque_on_grain;
};
/// Where a grain touches a candidate wall, in the world's frame.
struct WallTouchAt {
  std::int32_t candidate;
  Vec3 point, normal;  ///< normal from the grain into the wall
  double distance;
};
struct WallScratch {  ///< working memory of one thread
  std::vector<WallTouchAt> touch;
  std::vector<WallContact> contact;
};
struct WallCandidate {
  std::int32_t wall, first_triangle, triangle_count;
};
/// Which walls each grain may touch, and its wall contacts with their histories. Rows by slot.
struct WallList {
  std::vector<std::int32_t> first;  ///< [slot + 1] into candidate
  std::vector<WallCandidate> candidate;
  std::vector<int> triangle;
  std::vector<std::int32_t> contact_first;  ///< [slot + 1] room for contacts
  std::vector<std::uint8_t> contact_count;  ///< [slot] in use
  std::vector<WallContact> contact;
};

/// Load of the grains on one wall.
struct WallSum {
  ExactSum force[3], torque[3];
  void add(const Vec3& f, const Vec3& t) {
    for (int a = 0; a < 3; ++a) force[a].add(f[a]), torque[a].add(t[a]);
  }
  void add(const WallSum& o) {
    for (int a = 0; a < 3; ++a) force[a].add(o.force[a]), torque[a].add(o.torque[a]);
  }
};

/// Sums of one block of grains; blocks do not depend on the thread count, and are added in order.
struct BlockBook {
  bool strayed = false;  ///< a grain left its path in the neighbour list by more than its allowance
  StrayWatch watch;
  double speed2 = 0, overlap = 0;
  GrainId fastest = -1;
  std::int64_t contact_sides = 0, wall_contacts = 0;  ///< a pair of grains has two sides
  ContactLoss loss;
  double wall_work = 0;
  std::vector<WallSum> wall;
  std::vector<Crossing> crossing;
};

class FetchAhead;
struct BlockScratch;  // dem/simulation/block_pass.h

struct Simulation::Impl {
  ~Impl();
  explicit Impl(const SimulationSetup& s);

  // set-up
  SimulationSetup setup;
  AnyLawTable laws;
  PeriodicBox box;
  std::array<double, 3> snap{};  ///< see snapped()
  std::vector<Counter> counters;

  // state
  std::vector<Sphere> sphere, next_sphere;  ///< next_*: what the running pass writes
  std::vector<Motion> motion, next_motion;
  std::vector<Load> load;  ///< of contacts only, valid unless `pending`
  std::vector<GrainCard> card;
  std::vector<std::int32_t> slot_of_id;  ///< -1 = removed
  PairList pairs;
  WallList wall_list;
  std::vector<WallModel> walls;
  std::vector<Vec3> wall_impulse;
  std::vector<WallLoad> wall_load;
  std::int64_t step_count = 0;
  ContactLoss lost;
  double wall_work = 0;

  // neighbour list book-keeping
  CellGrid grid;
  std::vector<Anchor> anchor;  ///< [slot]; see dem/neighbours/reach_plan.h
  std::vector<double> reach;   ///< [slot] of the search, when the list was built
  ReachExperience reach_experience;
  double list_life_s = 0, farthest_m = 0;
  std::int64_t listed = 0;  ///< grains in the list; later slots are new
  std::int64_t step_of_build = 0;
  bool list_valid = false, forces_valid = false;
  /// Forces of the present positions are still to come, and with them the second half kick: the next step does both in the pass that moves the grains
  /// on, unless somebody looks before (finish_step). Same bytes either way.
  bool pending = false;
  bool one_material = true;  ///< all grains of one material: law parameters stay in the batch
  bool any_frozen = false;   ///< of the grains in the list
  std::vector<Crossing> crossings;
  std::vector<BlockBook> books;
  std::vector<std::unique_ptr<BlockScratch>> thread_scratch;  ///< [thread]
  StepStatistics stats;
  std::int64_t living = 0;  ///< grains not removed

  std::int64_t grains() const { return static_cast<std::int64_t>(sphere.size()); }
  std::int64_t blocks() const { return (grains() + kGrainsPerBlock - 1) / kGrainsPerBlock; }
  std::size_t block_end(std::size_t b) const { return std::min(PairList::block_start(b + 1), sphere.size()); }
  BlockScratch& my_scratch();                                                                          ///< of the calling thread of a team
  int team() const { return static_cast<int>(std::clamp<std::int64_t>(blocks(), 1, setup.threads)); }  ///< threads worth waking
  double time() const { return static_cast<double>(step_count) * setup.time_step_s; }
  std::size_t slot(GrainId id) const;  ///< \throws UsageError for an unknown id

  // the step
  void step_once();
  void evaluate(bool each_contact = true);
  void move_walls(double time_s);
  void advance();      ///< forces of the last step and its second half kick (if pending), first half kick, drift
  void finish_step();  ///< forces and second half kick now
  bool watch_block(std::size_t block, const MoveBook& moved);  ///< whether a grain of it has strayed, after its move
  bool strayed() const;
  bool list_is_stale() const;
  void rebuild_list();
  void rebuild_walls(const std::vector<std::int32_t>& old_slot);
  void take_forces(double dt, bool each_contact);  ///< sums over contacts into load; if wanted also the force of each (BlockContacts::kept)
  void note_crossings(std::size_t block);
  MoveView move_view(const BlockScratch& mine) const;
  void fetch_block(FetchAhead& ahead, std::size_t block) const;
  PairView pair_view(std::size_t block, LoadRow* sum);
  void settle_contacts(double dt);  ///< books of block_forces()
  void settle_motion();             ///< books of move_grain()
  template <class L>
  void wall_forces(const LawTable<L>& table, std::size_t s, double dt, BlockBook& book, WallScratch& scratch, LoadRow& sum);
  void find_wall_touches(std::size_t s, std::vector<WallTouchAt>& touch) const;

  // helpers
  /// Rounds a displacement to the grid of 2^-52 of the box size in periodic directions: positions are then exact multiples of one quantum, so that
  /// wrapping and images are exact and a pair across a face moves bit for bit as one in the middle.
  double snapped(int axis, double v) const { return (v + snap[static_cast<std::size_t>(axis)]) - snap[static_cast<std::size_t>(axis)]; }
  Vec3 unwrapped(std::size_t s) const;
  Vec3 wrapped(const Vec3& p) const;
  std::array<double, 3> wrap_correction(const Sphere& s) const;  ///< to add to get inside the box
  GrainId add(const GrainInput& g);
};

void check_setup(const SimulationSetup& s);
}  // namespace venato::dem
