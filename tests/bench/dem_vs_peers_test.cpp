#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

// What tests/bench/dem_vs_peers does with its arguments, before it installs, builds or runs anything.
namespace venato {
namespace {
struct Ran {
  int exit_code;
  std::string text;  ///< stdout and stderr
};
Ran run(const std::string& arguments) {
  std::FILE* pipe = ::popen((VENATO_SOURCE_DIR "/tests/bench/dem_vs_peers " + arguments + " 2>&1").c_str(), "r");
  if (!pipe) return {-1, "popen failed"};
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}
}  // namespace

TEST(DemVsPeers, ListsItsCases) {
  const Ran r = run("--list");
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.text, "mono100k_shear\nmono100k_static\npoly100k_shear\nmono1M_shear\npoly1M_shear\n");
}

TEST(DemVsPeers, HelpNamesEveryOption) {
  const Ran r = run("--help");
  EXPECT_EQ(r.exit_code, 0);
  for (const char* option : {"--ranks", "--repeat", "--out", "--build", "--scaling", "--ceilings", "--list"})
    EXPECT_NE(r.text.find(option), std::string::npos) << option;
}

TEST(DemVsPeers, WrongUsageExitsWithTwoAndSaysWhat) {
  const std::array<std::array<const char*, 2>, 8> wrong{{{"mono100k_shaer", "unknown case: mono100k_shaer"},
                                                         {"mono100k", "unknown case: mono100k"},
                                                         {"--nonsense", "unknown option: --nonsense"},
                                                         {"--ranks", "--ranks needs a value"},
                                                         {"--ranks 0", "--ranks 0 is not"},
                                                         {"--ranks two", "--ranks two is not"},
                                                         {"--repeat -1", "--repeat -1 is not"},
                                                         {"--scaling --build /nowhere", "there is no dem_shear_bench"}}};
  for (const auto& [arguments, says] : wrong) {
    const Ran r = run(arguments);
    EXPECT_EQ(r.exit_code, 2) << arguments;
    EXPECT_NE(r.text.find(says), std::string::npos) << r.text;
    EXPECT_NE(r.text.find("usage:"), std::string::npos) << arguments;
  }
}
}  // namespace venato
