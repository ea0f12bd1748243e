#include "base/io/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "base/error.h"
#include "tests/base/temp_folder.h"

namespace venato {
namespace fs = std::filesystem;

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST(AtomicFile, WritesAndReplaces) {
  TempFolder folder;
  write_text_atomically(folder / "a.txt", "one");
  EXPECT_EQ(read_file(folder / "a.txt"), "one");
  write_text_atomically(folder / "a.txt", std::string("t\0wo", 4));
  EXPECT_EQ(read_file(folder / "a.txt"), std::string("t\0wo", 4));
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtomicFile, FinalNameAppearsOnlyAtTheEnd) {
  TempFolder folder;
  const fs::path final_path = folder / "a.bin";
  write_atomically(final_path, [&](const fs::path& partial) {
    std::ofstream(partial) << "half";
    EXPECT_FALSE(fs::exists(final_path));
    EXPECT_EQ(partial.parent_path(), final_path.parent_path());  // same file system, else rename is a copy
  });
  EXPECT_TRUE(fs::exists(final_path));
}

TEST(AtomicFile, ExceptionLeavesNothingAndKeepsTheOldFile) {
  TempFolder folder;
  const auto fails = [](const fs::path& partial) {
    std::ofstream(partial) << "half";
    throw std::runtime_error("stop here");
  };
  EXPECT_EQ(error_of([&] { write_atomically(folder / "a", fails); }), "stop here");
  EXPECT_EQ(folder.file_count(), 0);
  write_text_atomically(folder / "a", "old");
  EXPECT_EQ(error_of([&] { write_atomically(folder / "a", fails); }), "stop here");
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtomicFile, MissingFolderIsWorkErrorWithPath) {
  TempFolder folder;
  EXPECT_THROW(write_text_atomically(folder / "no/such/a.txt", "x"), WorkError);
  EXPECT_NE(error_of([&] { write_text_atomically(folder / "no/such/a.txt", "x"); }).find("no/such/a.txt"), std::string::npos);
}

TEST(AtomicFile, WriterThatWritesNothingIsAnError) {
  TempFolder folder;
  EXPECT_THROW(write_atomically(folder / "a", [](const fs::path&) {}), WorkError);
}

TEST(ReadFile, RefusesMissingFolderAndTooLarge) {
  TempFolder folder;
  EXPECT_THROW(read_file(folder / "none"), UsageError);
  EXPECT_NE(error_of([&] { read_file(folder / "none"); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { read_file(folder.path()); }).find("is a folder"), std::string::npos);
  write_text_atomically(folder / "big", std::string(100, 'x'));
  EXPECT_EQ(read_file(folder / "big", 100).size(), 100u);
  EXPECT_NE(error_of([&] { read_file(folder / "big", 99); }).find("100 bytes, the limit is 99"), std::string::npos);
}

TEST(OutputFolder, MakesParentsAndRefusesAFileInTheWay) {
  TempFolder folder;
  make_output_folder(folder / "a/b/c");
  EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
  write_text_atomically(folder / "file", "x");
  EXPECT_THROW(make_output_folder(folder / "file"), UsageError);
  EXPECT_THROW(make_output_folder(folder / "file/below"), UsageError);
}

TEST(FreeSpace, SaysWhatIsNeededAndWhatIsThere) {
  TempFolder folder;
  EXPECT_NO_THROW(require_free_space(folder.path(), 1, "a test"));
  const std::string text = error_of([&] { require_free_space(folder.path(), 1ull << 60, "the printer file"); });
  EXPECT_NE(text.find("the printer file needs 1073741824.0 GiB"), std::string::npos) << text;
  EXPECT_NE(text.find("GiB free on " + folder.path().string()), std::string::npos) << text;
}
}  // namespace venato
