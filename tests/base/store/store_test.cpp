#include "base/store/store.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <stdexcept>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "tests/base/temp_folder.h"

namespace venato {
namespace fs = std::filesystem;

std::function<void(const fs::path&)> writes(std::string text) {
  return [text](const fs::path& p) { std::ofstream(p) << text; };
}

// FIPS 180-4 example values.
TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, FileOfSeveralPieces) {
  TempFolder folder;
  const std::string big((3u << 20) + 17, 'z');
  write_text_atomically(folder / "big", big);
  EXPECT_EQ(sha256_of_file(folder / "big"), sha256_hex(big));
  EXPECT_THROW(sha256_of_file(folder / "none"), WorkError);
}

// The literal pins the key's recipe: a change makes every stored operator unfindable and must be deliberate.
TEST(StoreKey, IsStableAndSeesEveryField) {
  const std::string key = store_key("press", "{\"a\":1}", {"p1", "p2"}, "v1");
  EXPECT_EQ(key, sha256_hex("14:venato-store-15:press7:{\"a\":1}1:22:p12:p22:v1"));
  EXPECT_NE(key, store_key("belt", "{\"a\":1}", {"p1", "p2"}, "v1"));
  EXPECT_NE(key, store_key("press", "{\"a\":2}", {"p1", "p2"}, "v1"));
  EXPECT_NE(key, store_key("press", "{\"a\":1}", {"p2", "p1"}, "v1"));
  EXPECT_NE(key, store_key("press", "{\"a\":1}", {"p1p2"}, "v1"));
  EXPECT_NE(key, store_key("press", "{\"a\":1}", {"p1", "p2"}, "v2"));
  EXPECT_NE(store_key("ab", "c", {}, ""), store_key("a", "bc", {}, ""));
}

TEST(Store, PutThenFind) {
  TempFolder folder;
  Store store(folder / "s");
  const std::string key = sha256_hex("x");
  EXPECT_FALSE(store.find("press", key));
  const fs::path path = store.put("press", key, "v1", writes("data"));
  EXPECT_EQ(path, folder / "s" / "press" / key.substr(0, 2) / (key + ".h5"));
  ASSERT_TRUE(store.find("press", key));
  EXPECT_EQ(read_file(*store.find("press", key)), "data");
  EXPECT_FALSE(store.find("belt", key));
  const std::string manifest = read_file(fs::path(path).replace_extension(".json"));
  EXPECT_NE(manifest.find("\"sha256\": \"" + sha256_hex("data") + "\""), std::string::npos);
  EXPECT_NE(manifest.find("\"code_version\": \"v1\""), std::string::npos);
}

TEST(Store, FailedWriterLeavesNoEntry) {
  TempFolder folder;
  Store store(folder.path());
  const std::string key = sha256_hex("x");
  EXPECT_THROW(store.put("press", key, "v1",
                         [](const fs::path& p) {
                           std::ofstream(p) << "half";
                           throw std::runtime_error("stop");
                         }),
               std::runtime_error);
  EXPECT_FALSE(store.find("press", key));
  EXPECT_EQ(folder.file_count(), 0);
}

class CorruptEntry : public ::testing::Test {
 protected:
  TempFolder folder;
  Store store{folder.path()};
  std::string key = sha256_hex("x");
  fs::path data = store.put("press", key, "v1", writes("data"));
  fs::path manifest = fs::path(data).replace_extension(".json");

  void expect_set_aside_and_replaceable() {
    EXPECT_FALSE(store.find("press", key));
    EXPECT_FALSE(fs::exists(data));
    EXPECT_FALSE(fs::exists(manifest));
    EXPECT_FALSE(store.find("press", key));  // still missing, not an error
    store.put("press", key, "v1", writes("data"));
    EXPECT_TRUE(store.find("press", key));
  }
};

TEST_F(CorruptEntry, ChangedByte) {
  std::ofstream(data) << "dAta";
  expect_set_aside_and_replaceable();
  EXPECT_EQ(read_file(data.string() + ".corrupt"), "dAta");
}
TEST_F(CorruptEntry, Truncated) {
  fs::resize_file(data, 2);
  expect_set_aside_and_replaceable();
}
TEST_F(CorruptEntry, ManifestMissing) {
  fs::remove(manifest);
  expect_set_aside_and_replaceable();
}
TEST_F(CorruptEntry, ManifestIsNotJson) {
  std::ofstream(manifest) << "{";
  expect_set_aside_and_replaceable();
}
TEST_F(CorruptEntry, DataMissing) {
  fs::remove(data);
  expect_set_aside_and_replaceable();
}

TEST(Store, Checkpoints) {
  TempFolder folder;
  const Store store(folder.path());
  const std::string key = sha256_hex("x");
  const fs::path path = store.checkpoint_path("dem", key);
  write_text_atomically(path, "state");
  EXPECT_FALSE(store.find("dem", key));  // work in progress is not a result
  EXPECT_TRUE(fs::exists(path));
  store.drop_checkpoint("dem", key);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_NO_THROW(store.drop_checkpoint("dem", key));
}

TEST(Store, DefaultRootFollowsTheEnvironment) {
  ::setenv("HOME", "/h", 1);
  ::unsetenv("VENATO_STORE");
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(Store::default_root(), "/h/.cache/venato");
  ::setenv("XDG_CACHE_HOME", "/c", 1);
  EXPECT_EQ(Store::default_root(), "/c/venato");
  ::setenv("VENATO_STORE", "/s", 1);
  EXPECT_EQ(Store::default_root(), "/s");
}

TEST(Store, RootThatCannotBeMadeIsUsageError) {
  TempFolder folder;
  write_text_atomically(folder / "file", "x");
  EXPECT_THROW(Store(folder / "file"), UsageError);
}
}  // namespace venato
