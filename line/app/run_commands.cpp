#include <cstdio>

#include "line/app/commands.h"
#include "line/chain/run_line.h"
#include "line/report/report.h"
namespace venato::line::app {
namespace {
constexpr int kOk = 0, kFailed = 1;
}

int run_command(const Options& o, Context& context) {
  std::vector<Override> overrides;
  for (const auto& text : o.overrides) overrides.push_back(parse_override(text));
  const auto config = load_line_config(o.input, overrides);
  const auto outcome = run_line(config, o.out, context);
  if (!o.quiet) std::fputs(outcome.summary.c_str(), stdout);
  if (!o.quiet) std::printf("report: %s\n", (o.out / "report.html").c_str());
  if (outcome.registered) return kOk;
  std::fprintf(stderr, "venato: registration failed: %s (the run is complete, the print files are as designed)\n", outcome.reason.c_str());
  return kFailed;
}

int report_command(const Options& o, Context& context) {
  write_report(o.input);
  context.log.info("report: " + (o.input / "report.html").string());
  return kOk;
}
}  // namespace venato::line::app
