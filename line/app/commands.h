#pragma once
#include "base/context.h"
#include "line/app/options.h"
namespace venato::line::app {
/// One function per verb; each returns the exit code. \throws UsageError, ConfigError, WorkError, Interrupted (turned into messages and codes by
/// main).
int run_command(const Options& options, Context& context);
int validate_command(const Options& options, Context& context);
int describe_command(const Options& options);
int dem_command(const Options& options, Context& context);
int sync_command(const Options& options, Context& context);
int masks_command(const Options& options, Context& context);
int report_command(const Options& options, Context& context);
}  // namespace venato::line::app
