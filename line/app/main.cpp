#include <cstdio>
#include <exception>
#include <new>

#include "base/error.h"
#include "base/hardware.h"
#include "base/store/store.h"
#include "line/app/commands.h"
#include "line/app/stop_signal.h"

namespace {
using namespace venato;
using namespace venato::line::app;

constexpr int kOk = 0, kFailed = 1, kUsage = 2, kStopped = 130;

int dispatch(const Options& o) {
  if (o.command == "describe-config") return describe_command(o);
  const auto verbosity = o.quiet ? Verbosity::quiet : Verbosity::normal;
  const auto format = o.json_log ? LogFormat::json : LogFormat::text;
  const auto log = make_stderr_log(format, verbosity);
  const auto progress = make_progress(*log, format, verbosity);
  Store store(Store::default_root());
  Context context{*log, *progress, store, 0, o.threads > 0 ? o.threads : available_cores(), &stop_flag()};
  if (o.command == "run") return run_command(o, context);
  if (o.command == "validate") return validate_command(o, context);
  if (o.command == "dem") return dem_command(o, context);
  if (o.command == "sync") return sync_command(o, context);
  if (o.command == "masks") return masks_command(o, context);
  return report_command(o, context);
}

int fail(int code, const char* what) {
  std::fprintf(stderr, "venato: %s\n", what);
  return code;
}
}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  const auto parsed = parse(argc, argv);
  if (parsed.finished) return parsed.exit_code;
  watch_stop_signals();
  try {
    const int code = dispatch(parsed.options);
    const bool written = std::fflush(stdout) == 0 && !std::ferror(stdout);
    return written ? code : fail(kFailed, "cannot write to standard output");
  } catch (const UsageError& e) {
    return fail(kUsage, e.what());
  } catch (const Interrupted& e) {
    fail(kStopped, e.what());
    return fail(kStopped, parsed.options.command == "dem"     ? "stopped; the same command with --resume goes on from the last checkpoint"
                          : parsed.options.command == "masks" ? "stopped; nothing was written"
                                                              : "stopped; run again to resume from the last checkpoint");
  } catch (const WorkError& e) {
    return fail(kFailed, e.what());
  } catch (const std::bad_alloc&) {
    return fail(kFailed, "not enough memory; a coarser grid/pitch_mm needs less");
  } catch (const std::exception& e) {
    return fail(kFailed, e.what());
  }
  return kOk;
}
