#pragma once
/// A DEM case as data: everything run_case() needs, no code. Stages build one, `venato dem CASE.json` reads one (dem/case_reader.h).
/// Frame: x across the belt, y along it (downstream positive), z up. SI units throughout.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>
#include "base/vec3.h"
#include "dem/material.h"
#include "dem/psd/size_distribution.h"

namespace venato::dem {

/// Powder = sizes + material; grains carry the index of their powder as `species` (the "colour").
struct Powder {
  std::string name;
  SizeDistribution psd;
  int material = 0;   ///< index into MaterialTable
};

/// Axis-aligned box; a grain whose centre leaves it in a non-periodic direction is removed and counted as lost (outflow "box").
struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  bool periodic[3] = {false, false, false};
};

// ---- walls -------------------------------------------------------------------------------------------------------------------
/// Infinite plane; grains live on the side the unit normal points to.
struct PlaneShape { Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ(); };
/// Inside (grains within) or outside of a cylinder of finite length; open ends.
struct CylinderShape { Vec3 base = Vec3::Zero(), axis = Vec3::UnitZ(); double length_m = 0, radius_m = 0; bool inside = true; };
struct Triangle { Vec3 a, b, c; };
/// Two-sided triangle mesh (one contact per nearest point: no double counting at shared edges and corners).
struct MeshShape { std::vector<Triangle> triangles; };
using WallShape = std::variant<PlaneShape, CylinderShape, MeshShape>;

/// Profile (y, z) polyline extruded across the belt from x_low to x_high (periodic x: give the box limits).
MeshShape extrude_profile(const std::vector<std::pair<double, double>>& yz_m, double x_low_m, double x_high_m);
/// Flat ring (inner radius 0: disc): plate with a round hole, its lid, the end of a drum. Polygons of the areas of the two circles.
/// \throws UsageError for radii that are no ring, a normal without length.
MeshShape make_ring(const Vec3& centre, const Vec3& normal, double inner_radius_m, double outer_radius_m, int segments = 64);
/// STL (or any mesh assimp reads), scaled to metres. \throws UsageError naming the file (missing, empty, not a mesh, > limits).
MeshShape load_mesh(const std::filesystem::path& file, double scale_to_m);

/// Half-open time interval [on, off).
struct Interval { double on_s = 0, off_s = std::numeric_limits<double>::infinity(); };

/// Rigid motion of a wall, sum of all parts. Velocities enter the contact law (tangential and normal).
struct WallMotion {
  Vec3 velocity_m_s = Vec3::Zero();                       ///< constant translation during `translate_when`
  std::vector<Interval> translate_when;                   ///< empty = always (if velocity != 0)
  struct PositionKnot { double time_s; Vec3 offset_m; };  ///< actuator track: offset linear between knots, held outside
  std::vector<PositionKnot> track;
  Vec3 rotation_centre = Vec3::Zero(), rotation_rad_s = Vec3::Zero();
  Vec3 vibration_amplitude_m = Vec3::Zero();              ///< offset = amplitude * sin(2 pi f t' + phase) - amplitude * sin(phase)
  double vibration_hz = 0, vibration_phase_rad = 0;
  /// On/off schedule; t' restarts at each `on`; empty = always (if amplitude != 0). After `off` the wall ends its swing at the next zero of the
  /// offset (at most one period later) and stays there: a drive does not jump back by an amplitude.
  std::vector<Interval> vibrate_when;
  Vec3 surface_velocity_m_s = Vec3::Zero();               ///< belt: the wall stays, its surface moves
};

struct Wall {
  std::string name;
  WallShape shape;
  WallMotion motion;
  int material = 0;
  Interval present;            ///< the wall exists only then (gates that are taken away, lids)
};

// ---- filling and emptying ----------------------------------------------------------------------------------------------------
/// Block of grains placed at t = 0 inside a region: loose on a jittered lattice without overlap, or as a dense random packing (dem/packing/pack_dense.h).
struct Fill {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::vector<double> powder_mass_fractions;   ///< one per powder, sum 1; grains are assigned at random
  double mass_kg = 0;                          ///< 0 = as many as the lattice holds
  Vec3 velocity_m_s = Vec3::Zero();
  /// > 0: dense random packing with this share of the region's volume (mass_kg must be 0). Periodic where the region spans a periodic box; its other faces
  /// are flat. Grains that overlap a wall or an earlier grain by more than kDenseFillOverlap of their radius are left out.
  double solid_fraction = 0;
};
constexpr double kDenseFillOverlap = 1e-3;     ///< of the smaller radius: largest overlap between grains of a fresh dense fill
/// Rain: grains appear without overlap at random places of a region at a mass rate while on; what does not fit is retried next step and
/// counted (`starved`).
struct Rain {
  std::string name;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::vector<double> powder_mass_fractions;
  double mass_rate_kg_s = 0;
  std::vector<Interval> when;                  ///< empty = always
  Vec3 velocity_m_s = Vec3::Zero();
  /// Level control: rain only while the highest centre of a grain that rests (touches something and is slower than resting_speed_m_s), in the columns
  /// under the region, is below level_z_m (NaN = off).
  double level_z_m = std::numeric_limits<double>::quiet_NaN();
  double resting_speed_m_s = 0.15;             ///< grains that touch something and are slower than this make up the level
};
/// Grains handed over from an earlier stage (position, velocity, spin, diameter, species), put in at their birth time.
struct GrainRecord {
  double time_s = 0;
  Vec3 position_m = Vec3::Zero(), velocity_m_s = Vec3::Zero(), spin_rad_s = Vec3::Zero();
  double diameter_m = 0;
  int species = 0;
  std::int64_t id = -1;                        ///< id in the run that produced the record
};
/// Axis-aligned counting plane: a grain whose centre crosses `position_m` along `axis` in direction `sign` inside the window is recorded
/// (once per grain when `remove` or `first_only`), and removed from the run when `remove`.
struct Counter {
  std::string name;
  int axis = 2;                                ///< 0 x, 1 y, 2 z
  double position_m = 0;
  int sign = -1;                               ///< crossing towards + or -
  Vec3 window_low = Vec3::Constant(-std::numeric_limits<double>::infinity());
  Vec3 window_high = Vec3::Constant(std::numeric_limits<double>::infinity());
  bool remove = false;
  bool first_only = true;
};

// ---- watching ----------------------------------------------------------------------------------------------------------------
/// Positions of all grains every `every_s` in [from_s, to_s): what velocity and diffusivity fields are made from.
struct SnapshotPlan { double from_s = 0, to_s = 0, every_s = 0; };
/// Continuum fields averaged over the instants from_s, from_s + every_s, … < to_s (dem/fields/continuum.h).
struct FieldPlan {
  double width_m = 0;                          ///< standard deviation of the kernel
  Vec3 cell_m = Vec3::Zero();                  ///< wanted cells; at least the box length = averaged over
  double from_s = 0, to_s = 0, every_s = 0;
  bool diffusivity = false;                    ///< also the diffusivity (keeps all positions of the window)
};
/// Time series of every counter, of grain number, mass, kinetic energy, wall forces.
struct SeriesPlan { double every_s = 0.005; };

/// Where the viewer stands: front looks along +y (x right, z up), side along -x (y right, z up: the way of the belt), top down (x right, y up).
enum class PictureView { front, side, top, oblique };
enum class PictureColour { powder, speed, size };
/// Pictures of the particles (dem/picture/picture.h) during a run.
struct PicturePlan {
  double every_s = 0;                          ///< 0 = none; from t = 0 on, and one at the end
  PictureView view = PictureView::front;
  PictureColour colour = PictureColour::powder;
  double full_speed_m_s = 0;                   ///< end of the speed scale; 0 = expected_max_speed_m_s
  int width_px = 900;
  bool has_region = false;                     ///< else the box
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// liggghts_hertz repeats LIGGGHTS' formulas with their faults, for comparing codes only (dem/contact/liggghts_hertz/law.h).
enum class LawKind { hertz_mindlin_epsd, eepa, liggghts_hertz };
struct EepaParameters { double stiffness_ratio_k2_k1 = 5, adhesion_ratio_kadh_k1 = 0.5, exponent = 1.5, constant_force_n = 0; };

/// Narrow place that grains must pass: never part of the run, only of the warning about coarse grains (dem/coarse_graining/openings.h).
struct Opening {
  std::string name;
  double size_m = 0;    ///< diameter of a hole, width of a slot or gap
  bool slot = false;
};

struct Rig;  // dem/rigs/rig_api.h

struct Case {
  std::string name;
  Box box;
  Vec3 gravity_m_s2 = Vec3(0, 0, -9.80665);
  MaterialTable materials;
  std::vector<Powder> powders;
  double coarse_graining = 1;                  ///< grain diameters are psd diameters times this (verification.md 7)
  LawKind law = LawKind::hertz_mindlin_epsd;
  EepaParameters eepa;
  double expected_max_speed_m_s = 1;           ///< v_max of the Hertz bound of the time step; watched while running
  double rayleigh_fraction = 0.20, hertz_fraction = 0.10;
  double time_step_s = 0;                      ///< 0 = min(rayleigh_fraction * t_R, hertz_fraction * t_H)
  double duration_s = 0;
  std::uint64_t seed = 0;
  std::vector<Wall> walls;
  std::vector<Fill> fills;
  std::vector<Rain> rains;
  std::vector<GrainRecord> handed_over;
  std::vector<Counter> counters;
  SeriesPlan series;
  std::vector<SnapshotPlan> snapshots;
  std::optional<FieldPlan> fields;
  double vtk_every_s = 0;                      ///< > 0: ParaView files (needs RunOptions::vtk_folder)
  PicturePlan pictures;                        ///< needs RunOptions::on_picture
  std::vector<Opening> openings;               ///< as stated by the case and its rig
  double layer_thickness_m = 0;                ///< thinnest layer that matters; 0 = not stated
  std::shared_ptr<const Rig> rig;              ///< bench rig that measures the result; null = none. Never changes the run
};
}  // namespace venato::dem
