#include "base/h5/h5_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "tests/base/temp_folder.h"

namespace venato {
namespace {
const H5Meta kMeta{"kg/m2", "y,x", "belt", "areal mass of the bed"};

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const WorkError& e) {
    return e.what();
  }
  return "";
}

void write_sample(const std::filesystem::path& path) {
  H5Writer w(path, "venato-test", 3);
  std::vector<double> big(300 * 200);  // 480 kB: chunked and compressed
  for (std::size_t i = 0; i < big.size(); ++i) big[i] = std::sin(static_cast<double>(i)) * 1e-3;
  w.dataset("/slab/deep/phi", big, {300, 200}, kMeta);
  w.dataset("/f", std::vector<float>{1.5f, -2.f, 0.1f}, {3}, kMeta);
  w.dataset("/i64", std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 7}, {1, 2}, kMeta);
  w.dataset("/i32", std::vector<std::int32_t>{-5, 6}, {2}, kMeta);
  w.dataset("/u8", std::vector<std::uint8_t>{0, 255}, {2}, kMeta);
  w.dataset("/empty", std::vector<double>{}, {0, 4}, kMeta);
  w.dataset("/scalar", std::vector<double>{42}, {}, kMeta);
  w.strings("/names", {"white", "", "grün"}, kMeta);
  w.attribute("/", "config", std::string(200000, 'c'));  // longer than HDF5's 64 kB limit of plain attributes
  w.attribute("/slab", "note", "");
  w.attribute("/slab/deep/phi", "seed", 12.25);
  w.close();
}
}  // namespace

TEST(H5, RoundTrip) {
  TempFolder folder;
  write_sample(folder / "a.h5");
  EXPECT_EQ(folder.file_count(), 1);
  const H5Reader r(folder / "a.h5", "venato-test", 3);
  const std::vector<double> big = r.doubles("/slab/deep/phi");
  ASSERT_EQ(big.size(), 60000u);
  for (std::size_t i = 0; i < big.size(); ++i) ASSERT_EQ(big[i], std::sin(static_cast<double>(i)) * 1e-3);
  EXPECT_EQ(r.dims("/slab/deep/phi"), (std::vector<std::uint64_t>{300, 200}));
  EXPECT_EQ(r.floats("/f"), (std::vector<float>{1.5f, -2.f, 0.1f}));
  EXPECT_EQ(r.doubles("/f")[0], 1.5);
  EXPECT_EQ(r.integers("/i64"), (std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 7}));
  EXPECT_EQ(r.integers("/i32"), (std::vector<std::int64_t>{-5, 6}));
  EXPECT_EQ(r.bytes("/u8"), (std::vector<std::uint8_t>{0, 255}));
  EXPECT_TRUE(r.doubles("/empty").empty());
  EXPECT_EQ(r.dims("/empty"), (std::vector<std::uint64_t>{0, 4}));
  EXPECT_EQ(r.doubles("/scalar"), std::vector<double>{42});
  EXPECT_TRUE(r.dims("/scalar").empty());
  EXPECT_EQ(r.strings("/names"), (std::vector<std::string>{"white", "", "grün"}));
  EXPECT_EQ(r.dataset_names(), (std::vector<std::string>{"/empty", "/f", "/i32", "/i64", "/names", "/scalar", "/slab/deep/phi", "/u8"}));
}

TEST(H5, AttributesAndMeta) {
  TempFolder folder;
  write_sample(folder / "a.h5");
  const H5Reader r(folder / "a.h5", "venato-test", 3);
  for (const std::string& name : r.dataset_names()) {
    const H5Meta m = r.meta(name);
    EXPECT_EQ(m.units, kMeta.units) << name;
    EXPECT_EQ(m.axes, kMeta.axes) << name;
    EXPECT_EQ(m.frame, kMeta.frame) << name;
    EXPECT_EQ(m.description, kMeta.description) << name;
  }
  EXPECT_EQ(r.text_attribute("/", "config"), std::string(200000, 'c'));
  EXPECT_EQ(r.text_attribute("/slab", "note"), "");
  EXPECT_EQ(r.number_attribute("/slab/deep/phi", "seed"), 12.25);
  EXPECT_TRUE(r.has("/slab/deep/phi"));
  EXPECT_FALSE(r.has("/slab/deeper/phi"));
}

TEST(H5, SameDataSameBytesAlsoASecondLater) {
  TempFolder folder;
  write_sample(folder / "a.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));  // HDF5 time stamps have whole seconds
  write_sample(folder / "b.h5");
  EXPECT_EQ(read_file(folder / "a.h5"), read_file(folder / "b.h5"));
}

TEST(H5, LargeDataIsCompressed) {
  TempFolder folder;
  {
    H5Writer w(folder / "z.h5", "venato-test", 1);
    w.dataset("/zeros", std::vector<float>(1 << 20), {1024, 1024}, kMeta);
    w.close();
  }
  EXPECT_LT(std::filesystem::file_size(folder / "z.h5"), 100000u);  // 4 MiB of zeros
}

TEST(H5, WithoutCloseNothingStays) {
  TempFolder folder;
  {
    H5Writer w(folder / "a.h5", "venato-test", 1);
    w.dataset("/x", std::vector<double>{1}, {1}, kMeta);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.h5"));
  }
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(H5, ErrorsNamePathAndReason) {
  TempFolder folder;
  write_sample(folder / "a.h5");
  const std::string path = (folder / "a.h5").string();
  const H5Reader r(folder / "a.h5", "venato-test", 3);
  EXPECT_NE(error_of([&] { r.doubles("/nothing"); }).find(path + ": cannot open dataset /nothing"), std::string::npos);
  EXPECT_NE(error_of([&] { r.integers("/f"); }).find("is not of whole numbers"), std::string::npos);
  EXPECT_NE(error_of([&] { r.bytes("/i64"); }).find("wider whole numbers"), std::string::npos);
  EXPECT_NE(error_of([&] { r.strings("/f"); }).find("not of fixed-length texts"), std::string::npos);
  EXPECT_NE(error_of([&] { r.text_attribute("/", "none"); }).find("attribute 'none'"), std::string::npos);
  EXPECT_EQ(error_of([&] { H5Reader(folder / "a.h5", "venato-run", 3); }), path + ": is a 'venato-test' file, expected 'venato-run'");
  EXPECT_NE(error_of([&] { H5Reader(folder / "a.h5", "venato-test", 2); }).find("format version 3"), std::string::npos);
  EXPECT_NE(error_of([&] { H5Reader(folder / "none.h5", "venato-test", 3); }).find("no such file"), std::string::npos);
  write_text_atomically(folder / "text.h5", "hello");
  EXPECT_NE(error_of([&] { H5Reader(folder / "text.h5", "venato-test", 3); }).find("is not an HDF5 file"), std::string::npos);
  EXPECT_THROW(H5Writer(folder / "no/such/a.h5", "venato-test", 1), WorkError);
}

TEST(H5, TruncatedFileIsAnError) {
  TempFolder folder;
  write_sample(folder / "a.h5");
  std::filesystem::resize_file(folder / "a.h5", std::filesystem::file_size(folder / "a.h5") / 2);
  EXPECT_NE(error_of([&] { H5Reader(folder / "a.h5", "venato-test", 3).doubles("/slab/deep/phi"); }), "");
}

TEST(H5DeathTest, ShapeMustFitTheData) {
  TempFolder folder;
  H5Writer w(folder / "a.h5", "venato-test", 1);
  EXPECT_DEATH(w.dataset("/x", std::vector<double>{1, 2, 3}, {2, 2}, kMeta), "precondition");
}
}  // namespace venato
