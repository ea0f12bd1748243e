#pragma once
/// Runs the built program as a user would, in a folder of its own.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/base/temp_folder.h"
namespace venato::e2e {
namespace fs = std::filesystem;

inline std::string slurp(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}
inline void spill(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

struct Ran {
  int code = -1;
  std::string out, err;
};
/// `arguments` goes to the shell as it is; @ stands for the test's folder. The store is a folder of the test.
inline Ran run_venato(const TempFolder& t, std::string arguments, const std::string& environment = {}) {
  for (std::size_t at; (at = arguments.find('@')) != std::string::npos;) arguments.replace(at, 1, t.path().string());
  const auto out = t / ".stdout", err = t / ".stderr";
  const std::string redirect = arguments.find('>') == std::string::npos ? " >" + out.string() : "";
  const std::string command = (environment.empty() ? "VENATO_STORE=" + (t / ".store").string() : environment) + " '" VENATO_BINARY_DIR "/venato' " +
                              arguments + redirect + " 2>" + err.string();
  const int status = std::system(command.c_str());
  Ran ran{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), fs::exists(out) ? slurp(out) : "", slurp(err)};
  std::error_code ignored;
  fs::remove(out, ignored);
  fs::remove(err, ignored);
  return ran;
}

/// configs/demo_slab.json with absolute picture paths, to be changed and written elsewhere.
inline nlohmann::json demo_config() {
  auto config = nlohmann::json::parse(slurp(VENATO_SOURCE_DIR "/configs/demo_slab.json"));
  for (const char* part : {"design", "graphic"})
    config[part]["image"] = std::string(VENATO_SOURCE_DIR "/configs/") + config[part]["image"].get<std::string>();
  return config;
}
}  // namespace venato::e2e
