#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "line/chain/masks_of_run.h"
namespace venato::line {

RunSource read_run_source(const std::filesystem::path& run) {
  const auto file = run / "run.json";
  const auto refuse = [&](const std::string& why) { throw UsageError(file.string() + ": " + why + "; is this the folder of a finished run?"); };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) refuse("no such file");
  const auto json = nlohmann::json::parse(read_file(file), nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("format", "") != "venato-run") refuse("not a run.json of Venato");
  try {
    return {json.at("system").at("config_file").get<std::string>(), json.at("input").dump()};
  } catch (const nlohmann::json::exception& e) {
    refuse(e.what());
  }
  return {};
}
}  // namespace venato::line
