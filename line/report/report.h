#pragma once
#include <filesystem>
namespace venato::line {
/// Writes <run>/report.html from run.json, score.json and figures/ of a finished run: one self-contained page (pictures inside, no requests to
/// anywhere), works from a file. \throws UsageError when the folder is not a run (missing or damaged run.json, score.json, figures); WorkError when
/// it cannot be written.
void write_report(const std::filesystem::path& run_folder);
}  // namespace venato::line
