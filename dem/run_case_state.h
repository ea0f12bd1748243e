#pragma once
/// Inside of run_case(): everything a running case carries from step to step, and its parts. All of it goes into the checkpoint.
#include <cstdint>
#include <string>
#include <vector>

#include "dem/fields/field_recorder.h"
#include "dem/run_case.h"
#include "dem/simulation/simulation.h"

namespace venato::dem {

struct GrainBirth {
  double time_s;
  Vec3 position_m;
};

/// Sizes and powders of the grains of one source, in order; entity k is always the same grain.
class GrainStream {
 public:
  GrainStream(const Case& c, const std::vector<double>& powder_mass_fractions, std::uint64_t stream);
  struct Draw {
    double diameter_m, mass_kg;
    int species, material;
  };
  Draw at(std::uint64_t entity);
  double largest_diameter_m() const { return largest_m_; }

 private:
  static constexpr std::uint64_t kChunk = 1024;
  const Case* case_;
  std::uint64_t stream_;
  std::vector<double> by_number_;  ///< cumulative number fraction of each powder
  double largest_m_ = 0;
  std::uint64_t chunk_ = ~std::uint64_t{0};
  std::vector<std::vector<double>> diameter_m_;  ///< [powder][entity in chunk]
};

struct RainState {
  double due_kg = 0;         ///< fallen due and not yet placed
  std::uint64_t entity = 0;  ///< next grain of its stream
};

struct CaseRun {
  CaseRun(const Case& c, const RunOptions& options, Context& context, double time_step_s);
  const Case& c;
  const RunOptions& options;
  Context& context;
  Simulation sim;
  CaseResult result;
  std::vector<GrainStream> rain_streams;

  // carried
  std::vector<GrainBirth> births;  ///< [id]
  std::vector<RainState> rains;
  std::vector<std::uint32_t> waiting;           ///< handed-over records not yet put in, by time
  std::vector<std::vector<std::uint8_t>> seen;  ///< [counter][id] crossed already
  std::vector<double> counter_mass_kg;
  std::vector<Vec3> impulse_before;  ///< of the last series sample
  double sampled_at_s = 0, fastest_since_sample_m_s = 0;
  std::int64_t samples = 0;
  std::vector<std::int64_t> frames;  ///< [plan]
  std::vector<double> vtk_times_s;
  std::int64_t pictures = 0;  ///< taken so far
  std::optional<FieldRecorder> fields;
  std::int64_t field_frames = 0;
  std::int64_t delayed_hand_overs = 0;
  std::uint8_t speed_warned = 0;

  GrainId put_in(const GrainInput& grain, double mass_kg);
  void take_out(GrainId id, double& mass_account_kg);
};

// run_case_dense_fill.cpp
/// \throws UsageError when the region is too small or its solid fraction cannot be reached.
void fill_dense(CaseRun& run, const Fill& fill, std::size_t index);
// run_case_sources.cpp
GrainInput grain_of(const GrainStream::Draw& draw, const Vec3& position_m, const Vec3& velocity_m_s);
void fill_regions(CaseRun& run);
void rain_and_hand_over(CaseRun& run);
// run_case_watch.cpp
void count_crossings(CaseRun& run);
void remove_outside(CaseRun& run);
/// \throws WorkError on a blow-up
void watch_speed(CaseRun& run);
void observe(CaseRun& run);
void finish_result(CaseRun& run);
// checkpoint.cpp
std::uint64_t case_fingerprint(const Case& c);
void save_checkpoint(const CaseRun& run, const std::filesystem::path& file);
/// \throws UsageError when the file belongs to another case, WorkError when it is damaged.
void load_checkpoint(CaseRun& run, const std::filesystem::path& file);
// run_case_vtk.cpp
void write_vtk(CaseRun& run);
/// Walls as they stand now, in triangles.
struct WallTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> wall;
};
WallTriangles present_walls(const CaseRun& run);
/// Position wrapped back into the box: what one wants to look at.
Vec3 in_box(const Box& box, Vec3 position);
// run_case_picture.cpp
void take_picture(CaseRun& run);
}  // namespace venato::dem
