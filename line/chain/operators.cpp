#include "line/chain/operators.h"

#include <chrono>

#include "base/error.h"
#include "base/io/file_lock.h"
#include "base/store/store.h"
namespace venato::line {
namespace {
constexpr const char* kKind = "operator";
/// Version of what all stages share on the way from a slice to an operator (DEM engine, fields, projection, pulse response, deposition on the kernel
/// grid). Raise it with every change there that changes results: stored operators of the version before are then not used any more.
constexpr const char* kSharedCodeVersion = "2";

std::filesystem::path checkpoint_folder(const Store& store, const std::string& key) {
  auto folder = store.checkpoint_path(kKind, key);
  folder += ".d";
  return folder;
}

/// Two processes that want the same operator must not write into one checkpoint folder: the second waits and takes what the first has made.
FileLock lock_checkpoints(const std::filesystem::path& folder, const std::string& stage, Context& context) {
  auto file = folder;
  file += ".lock";
  bool said = false;
  return FileLock::take(file, [&] {
    if (!said) context.log.info(stage + ": another process is making the same operator, waiting for it");
    said = true;
    if (context.stop_requested()) throw Interrupted(stage + ": stopped while waiting for another process");
  });
}

std::optional<Operator> from_store(const Store& store, const std::string& key, Log& log) {
  const auto file = store.find(kKind, key);
  if (!file) return std::nullopt;
  try {
    return read_operator(*file);
  } catch (const WorkError& e) {
    log.warn("operator in the store is not readable and is made again: " + std::string(e.what()));
    return std::nullopt;
  }
}
}  // namespace

std::string operator_key(const LineConfig& config, const ConfiguredStage& stage) {
  const std::string inputs = "{\"basics\":" + operator_inputs_json(config.basics) + ",\"stage\":" + stage.inputs_json + ",\"files\":" + [&] {
    const auto files = file_hashes_json(stage.inputs_json, config.file.parent_path());
    return files.empty() ? std::string("{}") : files;
  }() + "}";
  return store_key(kKind, inputs, {},
                   std::string(stage.descriptor->name) + " " + std::string(stage.descriptor->code_version) + " shared " + kSharedCodeVersion);
}

StageOperator obtain_operator(const LineConfig& config, const ConfiguredStage& stage, Context& context) {
  const auto start = std::chrono::steady_clock::now();
  StageOperator out;
  out.key = operator_key(config, stage);
  const auto folder = checkpoint_folder(context.store, out.key);
  auto found = from_store(context.store, out.key, context.log);
  std::optional<FileLock> lock;
  if (!found) {
    lock.emplace(lock_checkpoints(folder, stage.stage.name, context));
    found = from_store(context.store, out.key, context.log);  // another process may have made it meanwhile
  }
  if (found) {
    out.op = std::move(*found);
    out.cached = true;
  } else {
    std::error_code ec;
    std::filesystem::create_directories(folder, ec);
    if (ec) throw WorkError("cannot create the checkpoint folder " + folder.string() + ": " + ec.message());
    out.op = stage.stage.characterise(config.basics, folder, context);
    const auto file =
        context.store.put(kKind, out.key, stage.descriptor->code_version, [&](const std::filesystem::path& tmp) { write_operator(tmp, out.op); });
    std::filesystem::remove_all(folder, ec);
    // Read back what was stored: a first run and a run from the store then work on the same bytes.
    out.op = read_operator(file);
  }
  out.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}
}  // namespace venato::line
