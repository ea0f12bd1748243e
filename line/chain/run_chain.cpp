#include "line/chain/run_chain.h"

#include <chrono>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/expects.h"
namespace venato::line {

void check_mass_book(const std::string& stage, double in_kg, double out_kg) {
  if (std::abs(in_kg - out_kg) <= kMassTolerance * std::max(std::abs(in_kg), std::abs(out_kg))) return;
  char text[200];
  std::snprintf(text, sizeof text, "%.9g kg went in and %.9g kg came out (limit 1e-6 relative)", in_kg, out_kg);
  throw WorkError("mass is not conserved in " + stage + ": " + text);
}

std::string stage_border_line(const StageRecord& r) {
  char text[200];
  std::snprintf(text, sizeof text, "%-16s %7.2f s  mass in %.4f kg  out %.4f kg", r.name.c_str(), r.wall_s, r.mass_in_kg, r.mass_out_kg);
  return text;
}

ChainResult apply_chain(const LineConfig& config, const LineBasics& basics, const std::vector<Operator>& operators, const FeedCommands& commands,
                        const JitterField& jitter, const ApplyOptions& options, Context& context) {
  VENATO_EXPECTS(operators.size() == config.chain.size());
  ChainResult out;
  out.state.commands = commands;
  for (const auto& head : commands.heads) out.commands_mass_kg += head.mass_kg();
  for (std::size_t s = 0; s < config.chain.size(); ++s) {
    const auto& stage = config.chain[s];
    if (context.stop_requested()) throw Interrupted("stopped before " + stage.stage.name);
    if (stage.descriptor->produces == ProductKind::slab) {
      if (options.before_press_only) return out;
      if (out.state.bed) {
        const double before = out.state.bed->total_mass_kg();
        out.state.bed = move_bed(*out.state.bed, jitter, context.threads);
        check_mass_book("belt jitter", before, out.state.bed->total_mass_kg());
      }
    }
    const auto start = std::chrono::steady_clock::now();
    // A stage whose operator carries no replicates contributes its best estimate.
    const int replicate = operators[s].replicates.empty() ? -1 : options.replicate;
    auto output = stage.stage.apply(operators[s], out.state, basics, context, replicate);
    StageRecord record{stage.stage.name, output.mass_in_kg, output.mass_out_kg,
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), std::move(output.kpi)};
    check_mass_book(record.name, record.mass_in_kg, record.mass_out_kg);
    out.state = std::move(output.state);
    if (options.log_stages) context.log.info(stage_border_line(record));
    out.stages.push_back(std::move(record));
  }
  if (out.state.slab) out.slab_mass_kg = out.state.slab->bed.total_mass_kg();
  return out;
}
}  // namespace venato::line
