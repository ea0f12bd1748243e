#include "graphics/colour/srgb.h"

#include <algorithm>
#include <cmath>
#include <numbers>
namespace venato::graphics {
namespace {
double decode(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
std::array<double, 256> make_linear() {
  std::array<double, 256> t{};
  for (int k = 0; k < 256; ++k) t[static_cast<std::size_t>(k)] = decode(k / 255.0);
  return t;
}
const std::array<double, 256>& linear_table() {
  static const auto table = make_linear();
  return table;
}
/// Linear values half way (in the encoded scale) between neighbouring samples: sample = how many borders lie at or below.
const std::array<double, 255>& borders() {
  static const auto table = [] {
    std::array<double, 255> t{};
    for (int k = 0; k < 255; ++k) t[static_cast<std::size_t>(k)] = decode((k + 0.5) / 255.0);
    return t;
  }();
  return table;
}
double power7(double v) {
  const double v2 = v * v;
  return v2 * v2 * v2 * v;
}
constexpr double kLabDelta = 6.0 / 29.0;
double lab_f(double t) { return t > kLabDelta * kLabDelta * kLabDelta ? std::cbrt(t) : t / (3 * kLabDelta * kLabDelta) + 4.0 / 29.0; }
double lab_f_inverse(double f) { return f > kLabDelta ? f * f * f : 3 * kLabDelta * kLabDelta * (f - 4.0 / 29.0); }
// IEC 61966-2-1 primaries; the white is the sum of each row.
constexpr double kXyz[3][3] = {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr double white(int k) { return kXyz[k][0] + kXyz[k][1] + kXyz[k][2]; }
}  // namespace

double srgb_to_linear(std::uint8_t v) { return linear_table()[v]; }
double srgb_encode(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }
std::uint8_t linear_to_srgb(double linear) {
  const auto& b = borders();
  return static_cast<std::uint8_t>(std::upper_bound(b.begin(), b.end(), linear) - b.begin());
}

Xyz xyz_from_linear(double r, double g, double b) {
  const auto row = [&](int k) { return kXyz[k][0] * r + kXyz[k][1] * g + kXyz[k][2] * b; };
  return {row(0), row(1), row(2)};
}
Xyz xyz_from_srgb(const Srgb8& c) { return xyz_from_linear(srgb_to_linear(c[0]), srgb_to_linear(c[1]), srgb_to_linear(c[2])); }
Lab lab_from_xyz(const Xyz& c) {
  const double x = lab_f(c.x / white(0)), y = lab_f(c.y / white(1)), z = lab_f(c.z / white(2));
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}
Xyz xyz_from_lab(const Lab& c) {
  const double y = (c.l + 16) / 116;
  return {white(0) * lab_f_inverse(y + c.a / 500), white(1) * lab_f_inverse(y), white(2) * lab_f_inverse(y - c.b / 200)};
}
Lab lab_from_srgb(const Srgb8& c) { return lab_from_xyz(xyz_from_srgb(c)); }

double delta_e2000(const Lab& x, const Lab& y) {
  constexpr double pi = std::numbers::pi, degree = pi / 180, k25_7 = 6103515625.0;  // 25^7
  const double c_mean = (std::hypot(x.a, x.b) + std::hypot(y.a, y.b)) / 2, c7 = power7(c_mean);
  const double g = 0.5 * (1 - std::sqrt(c7 / (c7 + k25_7)));
  const double a1 = (1 + g) * x.a, a2 = (1 + g) * y.a, c1 = std::hypot(a1, x.b), c2 = std::hypot(a2, y.b);
  const auto hue = [&](double a, double b) {
    if (a == 0 && b == 0) return 0.0;
    const double h = std::atan2(b, a);
    return h < 0 ? h + 2 * pi : h;
  };
  const double h1 = hue(a1, x.b), h2 = hue(a2, y.b);
  double dh = 0, h_mean = h1 + h2;
  if (c1 * c2 != 0) {
    dh = h2 - h1;
    if (dh > pi) dh -= 2 * pi;
    if (dh < -pi) dh += 2 * pi;
    if (std::abs(h1 - h2) <= pi)
      h_mean = (h1 + h2) / 2;
    else
      h_mean = (h1 + h2 < 2 * pi ? h1 + h2 + 2 * pi : h1 + h2 - 2 * pi) / 2;
  }
  const double dl = y.l - x.l, dc = c2 - c1, dhh = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2);
  const double l_mean = (x.l + y.l) / 2, cp = (c1 + c2) / 2;
  const double t = 1 - 0.17 * std::cos(h_mean - 30 * degree) + 0.24 * std::cos(2 * h_mean) + 0.32 * std::cos(3 * h_mean + 6 * degree) -
                   0.20 * std::cos(4 * h_mean - 63 * degree);
  const double turn = (h_mean / degree - 275) / 25, theta = 30 * degree * std::exp(-turn * turn), cp7 = power7(cp);
  const double rc = 2 * std::sqrt(cp7 / (cp7 + k25_7)), l50 = (l_mean - 50) * (l_mean - 50);
  const double sl = 1 + 0.015 * l50 / std::sqrt(20 + l50), sc = 1 + 0.045 * cp, sh = 1 + 0.015 * cp * t, rt = -std::sin(2 * theta) * rc;
  return std::sqrt(dl / sl * (dl / sl) + dc / sc * (dc / sc) + dhh / sh * (dhh / sh) + rt * (dc / sc) * (dhh / sh));
}
}  // namespace venato::graphics
