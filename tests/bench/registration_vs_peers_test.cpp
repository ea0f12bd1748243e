#include <gtest/gtest.h>
#include <sys/wait.h>
#include <array>
#include <cstdio>
#include <string>

// What tests/bench/registration_vs_peers does with its arguments, before it installs, builds or runs anything.
namespace venato {
namespace {
struct Ran {
  int exit_code;
  std::string text;  ///< stdout and stderr
};
Ran run(const std::string& arguments) {
  std::FILE* pipe = ::popen((VENATO_SOURCE_DIR "/tests/bench/registration_vs_peers " + arguments + " 2>&1").c_str(), "r");
  if (!pipe) return {-1, "popen failed"};
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}
}  // namespace

TEST(RegistrationVsPeers, HelpNamesEveryOption) {
  const Ran r = run("--help");
  EXPECT_EQ(r.exit_code, 0);
  for (const char* option : {"--set", "--pairs", "--unrelated", "--threads", "--no-peers", "--out", "--build"})
    EXPECT_NE(r.text.find(option), std::string::npos) << option;
}

TEST(RegistrationVsPeers, WrongUsageExitsWithTwoAndSaysWhat) {
  const std::array<std::array<const char*, 2>, 6> wrong{{{"--nonsense", "unknown option: --nonsense"},
                                                         {"--pairs", "--pairs needs a value"},
                                                         {"--pairs few", "--pairs few is not"},
                                                         {"--threads 0", "--threads 0 is not"},
                                                         {"--set all", "--set all is neither"},
                                                         {"--build /nowhere", "there is no registration_bench"}}};
  for (const auto& [arguments, says] : wrong) {
    const Ran r = run(arguments);
    EXPECT_EQ(r.exit_code, 2) << arguments;
    EXPECT_NE(r.text.find(says), std::string::npos) << r.text;
    EXPECT_NE(r.text.find("usage:"), std::string::npos) << arguments;
  }
}
}  // namespace venato
