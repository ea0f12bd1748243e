#include "graphics/colour/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
namespace venato::graphics {
namespace {
TEST(Srgb, EverySampleRoundTrips) {
  for (int v = 0; v < 256; ++v) EXPECT_EQ(linear_to_srgb(srgb_to_linear(static_cast<std::uint8_t>(v))), v);
}
TEST(Srgb, KnownValues) {
  // IEC 61966-2-1: sRGB 188 is half the light to 0.25 %; the ends are exact; values beyond are clamped.
  EXPECT_NEAR(srgb_to_linear(188), 0.5028865, 1e-6);
  EXPECT_EQ(srgb_to_linear(0), 0);
  EXPECT_NEAR(srgb_to_linear(255), 1, 1e-15);
  EXPECT_EQ(linear_to_srgb(-1), 0);
  EXPECT_EQ(linear_to_srgb(2), 255);
  EXPECT_NEAR(srgb_encode(0.5), 0.7353570, 1e-6);
}
TEST(Lab, KnownColours) {
  // Widely published D65 values of the sRGB primaries (e.g. Lindbloom's calculator), to its printed digits.
  const auto near = [](const Srgb8& c, Lab want, double tolerance) {
    const Lab got = lab_from_srgb(c);
    EXPECT_NEAR(got.l, want.l, tolerance);
    EXPECT_NEAR(got.a, want.a, tolerance);
    EXPECT_NEAR(got.b, want.b, tolerance);
  };
  near({255, 255, 255}, {100, 0, 0}, 1e-6);
  near({0, 0, 0}, {0, 0, 0}, 1e-9);
  near({255, 0, 0}, {53.24, 80.09, 67.20}, 0.02);
  near({0, 0, 255}, {32.30, 79.19, -107.86}, 0.02);
  near({119, 119, 119}, {50.03, 0, 0}, 0.02);
}
TEST(Lab, XyzGoesThereAndBack) {
  const Xyz white = xyz_from_linear(1, 1, 1);
  EXPECT_NEAR(white.x, 0.95047, 5e-6);  // D65, 2 degrees
  EXPECT_NEAR(white.y, 1, 2e-7);
  EXPECT_NEAR(white.z, 1.08883, 5e-6);
  for (const Lab& lab : {Lab{0, 0, 0}, Lab{5, 3, -4}, Lab{50, 80, -107}, Lab{100, 0, 0}, Lab{104, -2, 3}}) {
    const Lab back = lab_from_xyz(xyz_from_lab(lab));
    EXPECT_NEAR(back.l, lab.l, 1e-9);
    EXPECT_NEAR(back.a, lab.a, 1e-9);
    EXPECT_NEAR(back.b, lab.b, 1e-9);
  }
  EXPECT_NEAR(lab_from_xyz({-0.001, -0.001, -0.001}).l, -0.903, 0.001);  // the line 903.3 Y goes on below zero
}
struct Pair {
  Lab x, y;
  double de;
};
TEST(DeltaE2000, SharmaData) {
  // Pairs of Sharma, Wu, Dalal (2005), table 1, printed to four digits.
  const Pair pairs[] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
                        {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
                        {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
                        {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
                        {{50, 0, 0}, {50, -1, 2}, 2.3669},
                        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
                        {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
                        {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
                        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
                        {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
                        {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
                        {{50, -1, 2}, {50, 0, 0}, 2.3669},
                        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
                        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
                        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
                        {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
                        {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
                        {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
                        {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
                        {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
                        {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
                        {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
                        {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
                        {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
                        {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
                        {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
                        {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
                        {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
                        {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
                        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
  for (const auto& p : pairs) {
    EXPECT_NEAR(delta_e2000(p.x, p.y), p.de, 5e-5);
    EXPECT_NEAR(delta_e2000(p.y, p.x), p.de, 5e-5);
  }
}
}  // namespace
}  // namespace venato::graphics
