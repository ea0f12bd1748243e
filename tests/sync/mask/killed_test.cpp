// A program that is killed while it writes the printer files. A file of its own: the children must fork before this process has started threads.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "sync/mask/mask_job.h"
#include "sync/mask/staged_folder.h"
#include "tests/sync/mask/mask_fixture.h"

namespace venato::sync {
namespace {
namespace fs = std::filesystem;

/// About a second of work for a child: 3000 x 4000 px, 6 inks.
MaskJob long_job() {
  MaskJob job = test::small_job();
  job.width_m = 3000 * 0.0254 / 360;
  job.height_m = 4000 * 0.0254 / 360;
  job.layers[0].ink = test::bands(540, 720, 6, 0.0004);
  return job;
}
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) names.push_back(entry.path().filename().string());
  return names;
}
bool is_partial(const std::string& name) { return name.rfind(".partial-", 0) == 0; }

TEST(MasksKilled, LeaveNoFileUnderAFinalNameAndTheNextRunClearsUp) {
  const MaskJob job = long_job();
  const test::TempFolder out;
  int killed_at_work = 0;
  for (const int milliseconds : {5, 40, 80, 160, 320}) {
    const fs::path folder = out.path / std::to_string(milliseconds);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      test::TestContext t;
      write_masks(job, folder, t.context);
      ::_exit(0);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (!WIFSIGNALED(status)) continue;  // it was faster: nothing to see here
    const auto left = names_in(folder);
    killed_at_work += !left.empty();
    // Either nothing has got its final name yet, or the kill fell between the renames: then the sidecar that vouches for the files is missing.
    for (const auto& name : left) EXPECT_NE(name, "masks.json");
    if (left.size() == 1) {
      EXPECT_TRUE(is_partial(left[0])) << left[0];
    }
  }
  EXPECT_GT(killed_at_work, 0) << "no child was killed while it wrote";

  const fs::path again = out.path / "40";
  fs::create_directories(again / ".partial-notes");  // not ours
  test::TestContext t;
  write_masks(test::small_job(), again, t.context);
  for (const auto& name : names_in(again)) {
    EXPECT_TRUE(!is_partial(name) || name == ".partial-notes") << name;
  }
  EXPECT_TRUE(fs::exists(again / "masks.json"));
}

TEST(MasksKilled, BetweenTheRenamesEveryFileIsWholeAndTheNextRunCompletes) {
  constexpr int kFiles = 3000;  // renames take long enough for the kill to fall between them
  const auto content = [](int k) { return std::string(2000, static_cast<char>('a' + k % 26)) + std::to_string(k); };
  const test::TempFolder out;
  int killed_between = 0;
  for (int attempt = 0; attempt < 20 && killed_between == 0; ++attempt) {
    const fs::path folder = out.path / std::to_string(attempt);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      StagedFolder staged(folder);
      for (int k = 0; k < kFiles; ++k) std::ofstream(staged.path() / ("file_" + std::to_string(k))) << content(k);
      std::ofstream(staged.path() / "masks.json") << "{}";
      staged.publish("masks.json");
      ::_exit(0);
    }
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!fs::exists(folder / "file_0") && std::chrono::steady_clock::now() < give_up) std::this_thread::yield();  // the first in name order
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    if (fs::exists(folder / "masks.json")) continue;  // all renames were done before the signal arrived
    int whole = 0;
    for (int k = 0; k < kFiles; ++k)
      if (const fs::path file = folder / ("file_" + std::to_string(k)); fs::exists(file)) {
        EXPECT_EQ(test::bytes_of(file), content(k));
        ++whole;
      }
    ASSERT_GT(whole, 0);
    if (whole == kFiles) continue;  // only the sidecar was missing
    ++killed_between;

    test::TestContext t;
    const MaskSet set = write_masks(test::small_job(), folder, t.context);
    EXPECT_TRUE(fs::exists(folder / "masks.json"));
    for (const auto& f : set.files) EXPECT_EQ(fs::file_size(folder / f.name), f.bytes) << f.name;
    for (const auto& name : names_in(folder)) EXPECT_FALSE(is_partial(name)) << name;
  }
  EXPECT_EQ(killed_between, 1) << "no kill fell between two renames";
}
}  // namespace
}  // namespace venato::sync
