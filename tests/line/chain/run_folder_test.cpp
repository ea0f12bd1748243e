#include "line/chain/run_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "tests/base/temp_folder.h"
namespace venato::line {
namespace fs = std::filesystem;
namespace {
std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(RunFolder, NothingIsLeftWhenItIsNotPublished) {
  TempFolder t;
  {
    RunFolder run(t.path() / "out");
    write_text_atomically(run.staging() / "a.txt", "a");
  }
  EXPECT_FALSE(fs::exists(t.path() / "out"));
}

TEST(RunFolder, AnOlderResultStaysUntilTheNewOneIsComplete) {
  TempFolder t;
  const auto out = t.path() / "out";
  fs::create_directories(out / "masks");
  write_text_atomically(out / "masks" / "old.txt", "old");
  write_text_atomically(out / "a.txt", "old");
  {
    RunFolder run(out);
    write_text_atomically(run.staging() / "a.txt", "half");
  }
  EXPECT_EQ(read_file(out / "a.txt"), "old");
  EXPECT_EQ(entries(out), 2u);
  {
    RunFolder run(out);
    write_text_atomically(run.staging() / "a.txt", "new");
    fs::create_directory(run.staging() / "masks");
    write_text_atomically(run.staging() / "masks" / "new.txt", "new");
    run.publish();
  }
  EXPECT_EQ(read_file(out / "a.txt"), "new");
  EXPECT_TRUE(fs::exists(out / "masks" / "new.txt"));
  EXPECT_FALSE(fs::exists(out / "masks" / "old.txt")) << "files of two runs must not mix";
  EXPECT_EQ(entries(out), 2u);
}

TEST(RunFolder, LeftoversOfAKilledRunAreCleared) {
  TempFolder t;
  const auto dead = t.path() / ".venato-partial-999999999", foreign = t.path() / ".venato-partial-notes";
  fs::create_directories(dead / "figures");
  fs::create_directories(foreign);
  RunFolder run(t.path());
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(foreign)) << "only what this program made";
}

TEST(RunFolder, AFileInTheWayIsRefused) {
  TempFolder t;
  write_text_atomically(t.path() / "out", "I am a file");
  EXPECT_THROW(RunFolder(t.path() / "out"), UsageError);
  EXPECT_EQ(read_file(t.path() / "out"), "I am a file");
}
}  // namespace
}  // namespace venato::line
