#include "graphics/icc/separate_by_profile.h"

#include "graphics/colour/srgb.h"
#include "tests/graphics/icc/synthetic_profile.h"
#include "tests/graphics/support.h"
namespace venato::graphics {
namespace {
using test::SyntheticProfile;
constexpr auto kIntent = RenderingIntent::relative_colorimetric;

Raster8 row_of(const std::vector<Srgb8>& colours) {
  Raster8 r(static_cast<int>(colours.size()), 1, 3, 1e-3);
  for (std::size_t k = 0; k < colours.size(); ++k)
    std::copy(colours[k].begin(), colours[k].end(), r.data.begin() + static_cast<std::ptrdiff_t>(3 * k));
  return r;
}
int largest_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  EXPECT_EQ(a.size(), b.size());
  int most = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}
/// The picture through the file by Little CMS alone, without its precalculated grid.
std::vector<std::uint8_t> direct(const std::filesystem::path& file, const Raster8& in, int inks) {
  cmsHPROFILE from = cmsCreate_sRGBProfile(), to = cmsOpenProfileFromFile(file.c_str(), "r");
  const auto format = COLORSPACE_SH(PT_ANY) | CHANNELS_SH(static_cast<cmsUInt32Number>(inks)) | BYTES_SH(1);
  cmsHTRANSFORM t = cmsCreateTransform(from, TYPE_RGB_8, to, format, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
  std::vector<std::uint8_t> out(static_cast<std::size_t>(in.width) * static_cast<std::size_t>(in.height * inks));
  cmsDoTransform(t, in.data.data(), out.data(), static_cast<cmsUInt32Number>(in.width * in.height));
  cmsDeleteTransform(t);
  cmsCloseProfile(from);
  cmsCloseProfile(to);
  return out;
}

class ByProfile : public testing::Test {
 protected:
  Graphic separate(const Raster8& in, int threads = 1) const { return separate_by_profile(in, file, kIntent, threads); }
  void expect_refused(const std::string& what) const {
    test::expect_usage_error([&] { separate(row_of({{1, 2, 3}})); }, file, what);
    test::expect_usage_error([&] { separate(row_of({{1, 2, 3}})); }, file, "wanted: an ICC output");
  }
  test::TempFolder folder;
  std::filesystem::path file = folder / "p.icc";
};

TEST_F(ByProfile, NamesDescriptionBodyAndSolidsComeFromTheProfile) {
  test::write_synthetic_profile(file);
  const Graphic g = separate(row_of({{255, 255, 255}}));
  std::vector<std::string> names;
  for (const Ink& ink : g.inks) names.push_back(ink.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Blue_1", "Brown", "Beige", "Yellow", "Pink", "Black"}));
  ASSERT_TRUE(g.profile);
  EXPECT_EQ(g.profile->description, "synthetic, not a printer");
  EXPECT_FALSE(g.separated_without_profile);
  // Two inks a channel: one full ink takes half of kDepth of its channel; the body lies kBodyLight below white.
  const int body = linear_to_srgb(test::kBodyLight), less = linear_to_srgb(test::kBodyLight * (1 - test::kDepth / 2));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g.body_srgb[c], body, 1);
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g.inks[k].solid_srgb[c], k % 3 == c ? less : body, 2) << k << " " << c;
}
TEST_F(ByProfile, WhiteNeedsNoInkAndLooksLikeTheBody) {
  test::write_synthetic_profile(file);
  const Graphic g = separate(row_of({{255, 255, 255}, {0, 0, 0}}));
  EXPECT_EQ(std::vector<std::uint8_t>(g.ink.data.begin(), g.ink.data.begin() + 6), std::vector<std::uint8_t>(6, 0));
  EXPECT_EQ(std::vector<std::uint8_t>(g.ink.data.begin() + 6, g.ink.data.end()), std::vector<std::uint8_t>(6, 255));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(g.srgb.data[c], g.body_srgb[c], 1);
}
TEST_F(ByProfile, AgreesWithLittleCmsItself) {
  test::write_synthetic_profile(file);
  const Raster8 in = test::test_pattern(97, 61, 3);
  const Graphic g = separate(in);
  const auto exact = direct(file, in, 6);
  // Inks of one channel follow each other: at that kink the grid over sRGB rounds the corner off.
  double sum = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) sum += std::abs(exact[k] - g.ink.data[k]);
  EXPECT_LT(sum / static_cast<double>(exact.size()), 1.0);
  EXPECT_LE(largest_difference(g.ink.data, exact), 16);
}
TEST_F(ByProfile, SameBytesForAnyThreadCount) {
  test::write_synthetic_profile(file);
  const Raster8 in = test::test_pattern(211, 83, 3);
  const Graphic one = separate(in, 1);
  for (const int threads : {2, 5, 16}) {
    const Graphic many = separate(in, threads);
    EXPECT_EQ(many.ink.data, one.ink.data) << threads;
    EXPECT_EQ(many.srgb.data, one.srgb.data) << threads;
    EXPECT_EQ(many.profile->out_of_gamut_share, one.profile->out_of_gamut_share);
  }
}
TEST_F(ByProfile, ShareOutOfGamutCountsPixels) {
  test::write_synthetic_profile(file);
  // Greys above the darkest print are in; black and pure blue are not.
  EXPECT_EQ(separate(row_of({{255, 255, 255}, {180, 180, 180}, {120, 130, 140}})).profile->out_of_gamut_share, 0.0);
  EXPECT_EQ(separate(row_of({{180, 180, 180}, {0, 0, 0}, {0, 0, 0}, {0, 0, 255}})).profile->out_of_gamut_share, 0.75);
}
TEST_F(ByProfile, TakesOneToFifteenInks) {
  for (const int inks : {1, 2, 4, 5, 15}) {
    SCOPED_TRACE(inks);
    test::write_synthetic_profile(file, {inks, 2, 17, {}});
    const Graphic g = separate(row_of({{255, 255, 255}, {90, 90, 90}}));
    ASSERT_EQ(g.ink.channels, inks);
    ASSERT_EQ(g.inks.size(), static_cast<std::size_t>(inks));
    const auto ink = [&](int k) { return g.ink.at(1, 0, k); };
    EXPECT_EQ(*std::max_element(g.ink.data.begin(), g.ink.data.begin() + inks), 0);
    EXPECT_GT(ink(0), 0);
    EXPECT_EQ(g.inks.back().name, inks == 1 || inks == 4 ? "black" : "ink_" + std::to_string(inks));
  }
}
TEST_F(ByProfile, NamesThatBecomeEqualStayApart) {
  test::write_synthetic_profile(file, {6, 2, 9, {"a b", "a_b", "", "d", "e", "f"}});
  const Graphic g = separate(row_of({{255, 255, 255}}));
  EXPECT_EQ(g.inks[0].name, "a_b");
  EXPECT_EQ(g.inks[1].name, "a_b_2");
  EXPECT_EQ(g.inks[2].name, "ink_3");
}

TEST_F(ByProfile, RefusesWhatIsNoOutputProfileOfInks) {
  expect_refused("does not exist");
  test::spill(file, "");
  expect_refused("is not an ICC profile");
  test::spill(file, std::string(500, 'x'));
  expect_refused("is not an ICC profile");
  cmsHPROFILE rgb = cmsCreate_sRGBProfile();
  cmsSaveProfileToFile(rgb, file.c_str());
  cmsCloseProfile(rgb);
  expect_refused("is a display profile (colour space 'RGB')");
  test::spill(file, test::slurp(file).replace(12, 4, "prtr"));
  expect_refused("not one of 1 to 15 inks (colour space 'RGB')");
  test::write_synthetic_profile(file, {6, 2, 9, {}});
  const std::string good = test::slurp(file);
  test::spill(file, std::string(good).replace(16, 4, "GCLR"));
  expect_refused("not one of 1 to 15 inks (colour space 'GCLR')");
  test::spill(file, std::string(good).replace(12, 4, "scnr"));
  expect_refused("is a profile of a scanner or camera");
}
TEST_F(ByProfile, RefusesMissingTables) {
  test::write_synthetic_profile(file, {6, 2, 9, {}, false, true});
  expect_refused("has no table from colour to inks (BToA0)");
  test::write_synthetic_profile(file, {6, 2, 9, {}, true, false});
  expect_refused("has no table from inks to colour (AToB0)");
  test::write_synthetic_profile(file, {6, 2, 9, {"one", "two"}});
  expect_refused("names 2 inks");
}
TEST_F(ByProfile, RefusesDamagedFiles) {
  test::write_synthetic_profile(file, {6, 2, 5, {}});
  const std::string good = test::slurp(file);
  for (std::size_t n = 0; n < good.size(); n += 1 + good.size() / 50) {
    test::spill(file, good.substr(0, n));
    expect_refused(n < 132 ? "is not an ICC profile" : "is truncated");
  }
  const std::size_t table = good.find("mBA ");
  ASSERT_NE(table, std::string::npos);
  test::spill(file, std::string(good).replace(table, 4, "????"));
  expect_refused("is a damaged ICC profile");
}

TEST_F(ByProfile, InksOfTheirOwnAreSeenThroughTheForwardTableAndStayAsTheyAre) {
  test::write_synthetic_profile(file);
  Raster8 ink(4, 1, 6, 1e-3);
  ink.data = {0, 0, 0, 0, 0, 0, 255, 0, 0, 255, 0, 0, 0, 128, 0, 0, 0, 0, 255, 255, 255, 255, 255, 255};
  const Graphic g = see_by_profile(ink, file, 2);
  EXPECT_EQ(g.ink.data, ink.data);
  const ProfileInks own = read_profile_inks(file);
  EXPECT_EQ(own.inks.size(), 6u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(g.srgb.data[c], own.body_srgb[c]) << "no ink is the body";
    const auto light = [&](double amount) { return linear_to_srgb(test::kBodyLight * (1 - test::kDepth * amount)); };
    EXPECT_NEAR(g.srgb.data[3 + c], light(c == 0 ? 1 : 0), 2) << "both inks of red";
    EXPECT_NEAR(g.srgb.data[6 + c], light(c == 1 ? 128 / 255.0 / 2 : 0), 2) << "half of one of the two inks of green";
    EXPECT_NEAR(g.srgb.data[9 + c], light(1), 2);
  }
  test::expect_usage_error([&] { see_by_profile(Raster8(2, 2, 5, 1e-3), file, 1); }, file, "profile of 6 inks; the graphic has 5");
}
}  // namespace
}  // namespace venato::graphics
