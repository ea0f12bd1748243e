/// The engine compiled at -O0, -O2 and as it ships gives the same bytes: no sum depends on what the compiler makes of the loops (-ffp-contract=off,
/// fixed lane order). The programs are built by the fixture of this test, so that ./check without --long does not compile the engine three times.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace {
std::string output_of(const std::string& program) {
  std::string text;
  FILE* pipe = popen((std::string(VENATO_BINARY_DIR) + "/tests/" + program).c_str(), "r");
  if (!pipe) return "could not start " + program;
  char buffer[256];
  while (std::fgets(buffer, sizeof buffer, pipe)) text += buffer;
  return pclose(pipe) == 0 ? text : program + " failed";
}
TEST(OptimisationLevels, GiveTheSameBytes) {
  const std::string shipped = output_of("state_hash_shipped");
  ASSERT_NE(shipped.find("law 1 step 2000"), std::string::npos) << shipped;
  EXPECT_EQ(output_of("state_hash_o2"), shipped);
  EXPECT_EQ(output_of("state_hash_o0"), shipped);
}
}  // namespace
