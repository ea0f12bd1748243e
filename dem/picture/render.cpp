#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "base/error.h"
#include "dem/picture/picture.h"

namespace venato::dem {
namespace {
constexpr int kSmallest = 16, kLargest = 8000;
constexpr double kAmbient = 0.35;
constexpr Rgb kInk{40, 40, 40}, kWallEdge{90, 110, 140};
constexpr double kWallTint = 0.06;   // of kWallEdge per layer of wall in front
constexpr double kCreaseCos = 0.94;  // edges between facets that differ by more than 20 degrees are drawn
constexpr double kMargin = 0.02;     // around what is shown

struct Camera {
  Vec3 right, up, toward;  ///< toward the viewer
};
Camera camera_of(PictureView view) {
  switch (view) {
    case PictureView::front:
      return {Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY()};
    case PictureView::side:
      return {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
    case PictureView::top:
      return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    case PictureView::oblique:
      break;
  }
  const Vec3 toward = Vec3(0.55, -1.0, 0.65).normalized(), right = Vec3::UnitZ().cross(toward).normalized();
  return {right, toward.cross(right), toward};
}

/// Picture coordinates of a point: x right, y down [px], depth towards the viewer [m].
struct Canvas {
  Camera camera;
  double left = 0, top = 0, px_per_m = 1;
  int width = 0, height = 0;
  std::vector<float> depth;
  std::vector<float> colour;  ///< [pixel][3]
  Vec3 place(const Vec3& p) const { return {(p.dot(camera.right) - left) * px_per_m, (top - p.dot(camera.up)) * px_per_m, p.dot(camera.toward)}; }
  std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x); }
  void blend(std::size_t k, const Rgb& c, double share) {
    for (std::size_t i = 0; i < 3; ++i) colour[3 * k + i] += static_cast<float>(share * (c[i] - static_cast<double>(colour[3 * k + i])));
  }
};

Canvas make_canvas(const PictureScene& scene, const PictureStyle& style) {
  Canvas c;
  c.camera = camera_of(style.view);
  double low_x = HUGE_VAL, high_x = -HUGE_VAL, low_y = HUGE_VAL, high_y = -HUGE_VAL;
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner(k & 1 ? scene.high.x() : scene.low.x(), k & 2 ? scene.high.y() : scene.low.y(), k & 4 ? scene.high.z() : scene.low.z());
    const double x = corner.dot(c.camera.right), y = corner.dot(c.camera.up);
    low_x = std::min(low_x, x), high_x = std::max(high_x, x), low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  if (!(high_x > low_x) || !(high_y > low_y) || !std::isfinite(high_x - low_x) || !std::isfinite(high_y - low_y))
    throw UsageError("picture: the region to show has no extent");
  const double margin = kMargin * std::max(high_x - low_x, high_y - low_y);
  low_x -= margin, high_x += margin, low_y -= margin, high_y += margin;
  const double height = style.width_px * (high_y - low_y) / (high_x - low_x);
  if (style.width_px < kSmallest || style.width_px > kLargest || height > kLargest)
    throw UsageError("picture: " + std::to_string(style.width_px) + " x " + std::to_string(std::lround(height)) + " px is outside [16, 8000] px");
  c.width = style.width_px * style.supersample;
  c.height = std::max(1, static_cast<int>(std::lround(height))) * style.supersample;
  c.px_per_m = c.width / (high_x - low_x);
  c.left = low_x, c.top = high_y;
  const std::size_t n = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
  c.depth.assign(n, -std::numeric_limits<float>::infinity());
  c.colour.resize(3 * n);
  for (std::size_t k = 0; k < 3 * n; ++k) c.colour[k] = kPaper[k % 3];
  return c;
}

void draw_grain(Canvas& c, const PictureGrain& g, const Vec3& light) {
  const Vec3 at = c.place(g.position_m);
  const double r = g.radius_m * c.px_per_m;
  const auto put = [&](int x, int y, double nx, double ny, double nz) {
    const std::size_t k = c.pixel(x, y);
    const auto depth = static_cast<float>(at.z() + nz * g.radius_m);
    if (!(depth > c.depth[k])) return;
    c.depth[k] = depth;
    const double shade = kAmbient + (1 - kAmbient) * std::max(0.0, nx * light.x() + ny * light.y() + nz * light.z());
    for (std::size_t i = 0; i < 3; ++i) c.colour[3 * k + i] = static_cast<float>(shade * g.colour[i]);
  };
  const int x0 = std::max(0, static_cast<int>(std::ceil(at.x() - r - 0.5))),
            x1 = std::min(c.width - 1, static_cast<int>(std::floor(at.x() + r - 0.5)));
  const int y0 = std::max(0, static_cast<int>(std::ceil(at.y() - r - 0.5))),
            y1 = std::min(c.height - 1, static_cast<int>(std::floor(at.y() + r - 0.5)));
  bool any = false;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double nx = (x + 0.5 - at.x()) / r, ny = (y + 0.5 - at.y()) / r, rest = 1 - nx * nx - ny * ny;
      if (rest <= 0) continue;
      any = true;
      put(x, y, nx, -ny, std::sqrt(rest));
    }
  if (any) return;
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));  // smaller than a pixel: one pixel
  if (x >= 0 && y >= 0 && x < c.width && y < c.height) put(x, y, 0, 0, 1);
}

/// Tint of one see-through triangle where nothing is in front of it.
void draw_wall(Canvas& c, const Triangle& t) {
  const Vec3 p = c.place(t.a), q = c.place(t.b), s = c.place(t.c);
  const double area = (q.x() - p.x()) * (s.y() - p.y()) - (q.y() - p.y()) * (s.x() - p.x());
  if (std::abs(area) < 1e-9) return;  // seen edge-on
  const auto [low_x, high_x] = std::minmax({p.x(), q.x(), s.x()});
  const auto [low_y, high_y] = std::minmax({p.y(), q.y(), s.y()});
  for (int y = std::max(0, static_cast<int>(std::floor(low_y))); y <= std::min(c.height - 1, static_cast<int>(high_y)); ++y)
    for (int x = std::max(0, static_cast<int>(std::floor(low_x))); x <= std::min(c.width - 1, static_cast<int>(high_x)); ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((s.y() - p.y()) * (px - p.x()) - (s.x() - p.x()) * (py - p.y())) / area;
      const double v = ((q.x() - p.x()) * (py - p.y()) - (q.y() - p.y()) * (px - p.x())) / area;
      if (u < 0 || v < 0 || u + v >= 1) continue;
      const std::size_t k = c.pixel(x, y);
      if (p.z() + u * (q.z() - p.z()) + v * (s.z() - p.z()) > static_cast<double>(c.depth[k])) c.blend(k, kWallEdge, kWallTint);
    }
}

void draw_edge(Canvas& c, const PictureScene& scene, const Vec3& from, const Vec3& to, int thickness) {
  double low = 0, high = 1;  // the part of the edge inside the region (Liang & Barsky)
  for (int axis = 0; axis < 3; ++axis) {
    const double along = to[axis] - from[axis], first = scene.low[axis] - from[axis], last = scene.high[axis] - from[axis];
    if (along == 0 && (first > 0 || last < 0)) return;
    if (along == 0) continue;
    low = std::max(low, std::min(first / along, last / along)), high = std::min(high, std::max(first / along, last / along));
  }
  if (low > high) return;
  const Vec3 a = c.place(from + low * (to - from)), b = c.place(from + high * (to - from));
  const int n = std::max(1, static_cast<int>(std::ceil(std::max(std::abs(b.x() - a.x()), std::abs(b.y() - a.y())))));
  if (n > 100000) return;
  for (int i = 0; i <= n; ++i) {
    const Vec3 p = a + (b - a) * (static_cast<double>(i) / n);
    for (int dy = 0; dy < thickness; ++dy)
      for (int dx = 0; dx < thickness; ++dx) {
        const int x = static_cast<int>(std::floor(p.x())) + dx, y = static_cast<int>(std::floor(p.y())) + dy;
        if (x < 0 || y < 0 || x >= c.width || y >= c.height) continue;
        const std::size_t k = c.pixel(x, y);
        if (p.z() > static_cast<double>(c.depth[k])) c.blend(k, kWallEdge, 0.7);
      }
  }
}

/// Borders, creases and outlines: edges of one triangle only, between facets at an angle, or where a curved wall turns away from the viewer.
void draw_edges(Canvas& c, const PictureScene& scene, int thickness) {
  using Key = std::array<double, 6>;
  const auto key = [](const Vec3& a, const Vec3& b) {
    const std::array<double, 3> p{a.x(), a.y(), a.z()}, q{b.x(), b.y(), b.z()};
    const auto& first = std::min(p, q);
    const auto& second = std::max(p, q);
    return Key{first[0], first[1], first[2], second[0], second[1], second[2]};
  };
  struct Seen {
    Vec3 normal = Vec3::Zero();
    int facets = 0;
    bool crease = false;
  };
  std::map<Key, Seen> edges;
  for (const Triangle& t : scene.walls) {
    const Vec3 n = (t.b - t.a).cross(t.c - t.a).normalized();
    const std::pair<Vec3, Vec3> sides[] = {{t.a, t.b}, {t.b, t.c}, {t.c, t.a}};
    for (const auto& [a, b] : sides) {
      Seen& seen = edges[key(a, b)];
      const bool outline = seen.normal.dot(c.camera.toward) * n.dot(c.camera.toward) < 0;  // one facet is seen from its front, one from its back
      if (++seen.facets > 1 && (outline || std::abs(seen.normal.dot(n)) < kCreaseCos)) seen.crease = true;
      seen.normal = n;
    }
  }
  for (const auto& [k, seen] : edges)
    if (seen.facets == 1 || seen.crease) draw_edge(c, scene, Vec3(k[0], k[1], k[2]), Vec3(k[3], k[4], k[5]), thickness);
}

RgbImage shrink(const Canvas& c, int by, int extra_rows) {
  RgbImage image;
  image.width = c.width / by;
  image.height = c.height / by + extra_rows;
  image.m_per_px = by / c.px_per_m;
  image.rgb.assign(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 255);
  for (int y = 0; y < c.height / by; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0;
        for (int dy = 0; dy < by; ++dy)
          for (int dx = 0; dx < by; ++dx) sum += static_cast<double>(c.colour[3 * c.pixel(x * by + dx, y * by + dy) + i]);
        image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) + i] =
            static_cast<std::uint8_t>(std::clamp(std::lround(sum / (by * by)), 0l, 255l));
      }
  return image;
}

void fill(RgbImage& image, int left, int top, int width, int height, const Rgb& colour) {
  for (int y = std::max(0, top); y < std::min(image.height, top + height); ++y)
    for (int x = std::max(0, left); x < std::min(image.width, left + width); ++x)
      std::copy(colour.begin(), colour.end(), image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x));
}

/// 1, 2 or 5 x 10^n, the largest that is not above `limit`.
double round_length(double limit) {
  const double decade = std::pow(10, std::floor(std::log10(limit)));
  return (limit >= 5 * decade ? 5 : limit >= 2 * decade ? 2 : 1) * decade;
}

void annotate(RgbImage& image, const PictureScene& scene, int top, int size) {
  draw_text(image, 4 * size, top + 3 * size, scene.caption, kInk, size);
  const double length = round_length(0.2 * image.width * image.m_per_px);
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", length * 1e3);
  const int px = static_cast<int>(std::lround(length / image.m_per_px)), right = image.width - 4 * size;
  const int bar_top = top + 14 * size;
  fill(image, right - px, bar_top, px, 2 * size, kInk);
  draw_text(image, right - px - text_width(text, size) - 3 * size, bar_top - 2 * size, text, kInk, size);
  if (scene.scale_title.empty()) return;
  int x = 4 * size;
  x += draw_text(image, x, bar_top - 2 * size, scene.scale_title + " " + scene.scale_low + " ", kInk, size);
  const int wide = 60 * size;
  for (int k = 0; k < wide; ++k) fill(image, x + k, bar_top - 2 * size, 1, 7 * size, scale_colour((k + 0.5) / wide));
  draw_text(image, x + wide + 4 * size, bar_top - 2 * size, scene.scale_high, kInk, size);
}

bool inside(const Vec3& p, const PictureScene& s) { return (p.array() >= s.low.array()).all() && (p.array() <= s.high.array()).all(); }

/// The part of a triangle inside the region (Sutherland & Hodgman: cut by one face after the other), as a fan of triangles.
std::vector<Triangle> cut_wall(const Triangle& t, const PictureScene& s) {
  std::vector<Vec3> polygon{t.a, t.b, t.c};
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const double face = sign > 0 ? s.low[axis] : -s.high[axis];
      std::vector<Vec3> kept;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        const double dp = sign * p[axis] - face, dq = sign * q[axis] - face;
        if (dp >= 0) kept.push_back(p);
        if ((dp >= 0) != (dq >= 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
      }
      polygon = std::move(kept);
    }
  std::vector<Triangle> parts;
  for (std::size_t k = 2; k < polygon.size(); ++k) parts.push_back({polygon[0], polygon[k - 1], polygon[k]});
  return parts;
}

}  // namespace

RgbImage render(const PictureScene& scene, const PictureStyle& style) {
  if (style.supersample < 1 || style.supersample > 8) throw UsageError("picture: supersample is outside [1, 8]");
  Canvas c = make_canvas(scene, style);
  const Vec3 light = Vec3(-0.4, 0.55, 0.75).normalized();  // from the upper left, towards the viewer
  for (const PictureGrain& g : scene.grains)
    if (inside(g.position_m, scene)) draw_grain(c, g, light);
  for (const Triangle& t : scene.walls)
    for (const Triangle& part : cut_wall(t, scene)) draw_wall(c, part);
  draw_edges(c, scene, style.supersample);
  const int size = std::max(1, style.width_px / 450);
  RgbImage image = shrink(c, style.supersample, style.annotate ? 20 * size : 0);
  if (style.annotate) annotate(image, scene, image.height - 20 * size, size);
  return image;
}
}  // namespace venato::dem
