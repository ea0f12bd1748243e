#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/base/temp_folder.h"

// ./run and ./check on a bare machine: what they say and do about missing packages and foreign build folders, with the system's commands
// replaced by small ones that note how they were called.
namespace venato {
namespace fs = std::filesystem;
namespace {

struct Ran {
  int exit_code;
  std::string text;  ///< stdout and stderr
};

Ran run(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return {-1, "popen failed"};
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

class Scripts : public ::testing::Test {
 protected:
  TempFolder folder;

  void command(const std::string& name, const std::string& body) {
    std::ofstream(folder / name) << "#!/bin/sh\n" << body << "\n";
    fs::permissions(folder / name, fs::perms::owner_all);
  }
  /// dpkg-query that knows all packages but these ("a|b").
  void all_installed_but(const std::string& names) {
    command("dpkg-query", "case $3 in " + names + ") exit 1;; esac; printf installed");
    command("apt-get", "echo \"apt-get $*\"");
    command("env", "shift; exec \"$@\"");
  }
  void user(int id) { command("id", "echo " + std::to_string(id)); }
  /// Runs `what` after sourcing the shared part, seeing only the commands above.
  Ran with_setup(const std::string& what) const {
    const std::string script =
        "set -euo pipefail; root=/nowhere; source " VENATO_SOURCE_DIR "/.ci/setup.sh; PATH=" + folder.path().string() + "; " + what;
    return run("bash -c '" + script + "'");
  }
};
bool has(const Ran& ran, const std::string& part) { return ran.text.find(part) != std::string::npos; }
}  // namespace

TEST_F(Scripts, NothingMissingCallsNothing) {
  all_installed_but("none");
  user(1000);
  const Ran r = with_setup("install_missing \"$build_packages$check_packages\"");
  EXPECT_EQ(r.exit_code, 0) << r.text;
  EXPECT_EQ(r.text, "");
}

TEST_F(Scripts, RootInstallsWhatIsMissingAndSaysWhy) {
  all_installed_but("libtiff-dev|cmake");
  user(0);
  const Ran r = with_setup("install_missing \"$build_packages\"");
  EXPECT_EQ(r.exit_code, 0) << r.text;
  EXPECT_TRUE(has(r, "libtiff-dev                N-ink printer files")) << r.text;
  EXPECT_TRUE(has(r, "apt-get -q -o DPkg::Lock::Timeout=300 update")) << r.text;
  EXPECT_TRUE(has(r, "install -y --no-install-recommends cmake libtiff-dev\n")) << r.text;
}

TEST_F(Scripts, UserInstallsThroughSudo) {
  all_installed_but("cmake");
  user(1000);
  command("sudo", "echo \"sudo was asked\"; exec \"$@\"");
  const Ran r = with_setup("install_missing \"$build_packages\"");
  EXPECT_EQ(r.exit_code, 0) << r.text;
  EXPECT_TRUE(has(r, "sudo was asked")) << r.text;
}

TEST_F(Scripts, NeitherRootNorSudoIsSaidPlainly) {
  all_installed_but("cmake");
  user(1000);
  const Ran r = with_setup("install_missing \"$build_packages\"");
  EXPECT_EQ(r.exit_code, 1) << r.text;
  EXPECT_TRUE(has(r, "neither root nor sudo")) << r.text;
  EXPECT_TRUE(has(r, "apt-get install --no-install-recommends cmake")) << r.text;
}

TEST_F(Scripts, FailingAptStopsTheScript) {
  all_installed_but("cmake");
  user(0);
  command("apt-get", "echo \"E: no network\"; exit 100");
  const Ran r = with_setup("install_missing \"$build_packages\"; echo went on");
  EXPECT_EQ(r.exit_code, 1) << r.text;
  EXPECT_FALSE(has(r, "went on")) << r.text;
}

TEST_F(Scripts, ForeignBuildFolderIsDroppedAndOurOwnKept) {
  const fs::path build = folder / "build";
  const auto make_cache = [&](const std::string& home) {
    fs::create_directories(build);
    std::ofstream(build / "CMakeCache.txt") << "CMAKE_HOME_DIRECTORY:INTERNAL=" << home << "\nCMAKE_CACHEFILE_DIR:INTERNAL=" << build.string()
                                            << "\nCMAKE_GENERATOR:INTERNAL=Ninja\n";
  };
  const std::string drop =
      "bash -c 'set -euo pipefail; root=/src; source " VENATO_SOURCE_DIR "/.ci/setup.sh; drop_foreign_build " + build.string() + "'";
  make_cache("/src");
  EXPECT_EQ(run(drop).exit_code, 0);
  EXPECT_TRUE(fs::exists(build / "CMakeCache.txt"));
  make_cache("/elsewhere");
  EXPECT_EQ(run(drop).exit_code, 0);
  EXPECT_FALSE(fs::exists(build));
}

TEST_F(Scripts, WrongUsageExitsWithTwo) {
  EXPECT_EQ(run(VENATO_SOURCE_DIR "/check --nonsense").exit_code, 2);
  EXPECT_EQ(run(VENATO_SOURCE_DIR "/run no_such_config.json").exit_code, 2);
  EXPECT_EQ(run(VENATO_SOURCE_DIR "/run --help").exit_code, 0);
  EXPECT_EQ(run(VENATO_SOURCE_DIR "/tests/fuzz/run many").exit_code, 2);
  EXPECT_EQ(run(VENATO_SOURCE_DIR "/tests/fuzz/run --seconds").exit_code, 2);
  EXPECT_EQ(run(VENATO_SOURCE_DIR "/tests/fuzz/run --help").exit_code, 0);
}
}  // namespace venato
