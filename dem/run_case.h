#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include "base/context.h"
#include "dem/case.h"
#include "dem/snapshot.h"

namespace venato::dem {
struct RgbImage;                 // dem/picture/picture.h
struct CaseReport;               // dem/case_outputs/case_outputs.h
struct FieldResult;               ///< dem/fields/field_recorder.h

struct CounterRecord {           ///< one grain crossing one counter
  double time_s;                 ///< linear interpolation inside the step
  Vec3 position_m;               ///< interpolated, periodic directions unwrapped (so displacement from birth is position - birth_position)
  Vec3 velocity_m_s, spin_rad_s, birth_position_m;
  double birth_time_s, mass_kg, diameter_m;
  std::int64_t id;
  int species;
};
struct TimeSeries {
  std::vector<double> time_s, grain_count, mass_kg, kinetic_energy_j, mean_contacts, max_speed_m_s, top_z_m;
  std::vector<std::vector<double>> counter_mass_kg;    ///< [counter][sample] cumulative
  std::vector<std::vector<Vec3>> wall_force_n;         ///< [wall][sample] mean over the sampling interval
};
struct CaseResult {
  bool complete = true;                                ///< false: stopped at RunOptions::until_s, before the end of the case
  double end_time_s = 0;                               ///< of final_state
  double time_step_s = 0;
  std::int64_t steps = 0;
  std::vector<std::vector<CounterRecord>> records;     ///< [counter], in order of time, then id
  TimeSeries series;
  std::vector<std::vector<Snapshot>> snapshots;        ///< [plan][frame]
  std::shared_ptr<const FieldResult> fields;           ///< of Case::fields; null without or when the run ended before the window
  std::vector<GrainRecord> final_state;                ///< sorted by id
  double mass_put_in_kg = 0, mass_removed_kg = 0, mass_lost_box_kg = 0, mass_left_kg = 0;   ///< book closes to rounding
  std::vector<double> rain_starved_kg;
  double max_speed_seen_m_s = 0, max_overlap_seen = 0; ///< overlap / radius of the smaller grain
  double particle_steps = 0, wall_clock_s = 0;         ///< wall_clock_s is of this process only; never stored with data
  std::vector<std::string> warnings;                   ///< e.g. coarse graining too coarse for an orifice
};

struct CaseCost { double particles, steps, particle_steps, memory_bytes, seconds; };   ///< before running: for validate and the progress bar
CaseCost estimate_cost(const Case& c, int threads);
double choose_time_step(const Case& c);                ///< design: min(20 % Rayleigh, 10 % Hertz) over the smallest grain and all materials

struct RunOptions {
  std::filesystem::path checkpoint;                    ///< empty = none; exists = resume from it, bit for bit
  double checkpoint_every_wall_s = 30;
  bool keep_checkpoint = false;                        ///< the finished case leaves its last state there: run again, it returns the same result at once
  double until_s = 0;                                  ///< > 0 and before the end of the case: stop there, leaving the checkpoint; going on from it
                                                       ///< gives the bytes of a run that never stopped
  std::filesystem::path vtk_folder;
  std::function<void(const RgbImage&, int frame, double time_s)> on_picture;   ///< gets the pictures that the case asks for
  bool profile = false;                                ///< log the time per phase at the end
};
/// Runs the case to its end. Same case and seed: same bytes for any thread count, interrupted and resumed or not.
/// Sources are served and the level looked at every 10 steps; grains outside the box are removed every 16 steps. Speeds above expected_max_speed_m_s give
/// a warning, above twice that the run ends. A finished run removes its checkpoint.
/// \throws WorkError "grain 812 at (…) reached 14 m/s at t = … (limit …): likely cause …" instead of a blow-up; Interrupted after
/// writing the checkpoint when context.stop is set.
CaseResult run_case(const Case& c, const RunOptions& options, Context& context);

/// Results to and from HDF5 (base/h5), so that analysis can be repeated without the DEM.
void write_case_result(const std::filesystem::path& file, const Case& c, const CaseResult& r, const CaseReport& report);
}  // namespace venato::dem
