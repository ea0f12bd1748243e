#include "dem/walls/nearest.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace venato::dem {
Vec3 nearest_on_triangle(const Triangle& t, const Vec3& p) {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return t.a;
  const Vec3 bp = p - t.b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return t.b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.a + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - t.c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return t.c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return t.b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t.c - t.b);
  // Face: project on the plane. The barycentric form loses digits in d - r when the triangle is large; this keeps plane and mesh equal to 1e-12.
  const Vec3 n = ab.cross(ac);
  return p - n.dot(ap) / n.squaredNorm() * n;
}

WallTouch touch_plane(const PlaneShape& s, const Vec3& centre) {
  const double d = s.normal.dot(centre - s.point);
  return {centre - d * s.normal, -s.normal, d};
}

std::optional<WallTouch> touch_cylinder(const CylinderShape& s, const Vec3& centre, double radius) {
  const Vec3 from_base = centre - s.base;
  const double along = s.axis.dot(from_base);
  const Vec3 across = from_base - along * s.axis;
  const double rho = across.norm();
  if (rho < 1e-12 * s.radius_m) return std::nullopt;  // on the axis: no side is nearer (radius >> grain)
  const Vec3 out = across / rho;
  if (along < 0 || along > s.length_m) {  // the rim of the open end
    const Vec3 rim = s.base + (along < 0 ? 0.0 : s.length_m) * s.axis + s.radius_m * out;
    const Vec3 to = rim - centre;
    const double d = to.norm();
    if (d >= radius || d == 0) return std::nullopt;
    return WallTouch{rim, to / d, d};
  }
  const double d = s.inside ? s.radius_m - rho : rho - s.radius_m;
  if (std::abs(d) >= radius) return std::nullopt;
  const Vec3 surface = s.base + along * s.axis + s.radius_m * out;
  return WallTouch{surface, s.inside ? out : Vec3(-out), d};
}

MeshTouches touch_mesh(const std::vector<Triangle>& triangles, const int* first, const int* last, const Vec3& centre, double radius) {
  struct Near {
    double d2;
    int triangle;
    Vec3 point;
  };
  constexpr int kMost = 64;
  Near near[kMost];
  int n = 0;
  for (const int* k = first; k != last; ++k) {
    const Vec3 q = nearest_on_triangle(triangles[static_cast<std::size_t>(*k)], centre);
    const double d2 = (q - centre).squaredNorm();
    if (!(d2 < radius * radius)) continue;
    if (n < kMost) {
      near[n++] = {d2, *k, q};
    } else {  // absurdly fine mesh: keep the nearest ones
      Near* worst = std::max_element(near, near + n, [](const Near& a, const Near& b) { return a.d2 < b.d2; });
      if (d2 < worst->d2) *worst = {d2, *k, q};
    }
  }
  std::sort(near, near + n, [](const Near& a, const Near& b) { return a.d2 < b.d2 || (a.d2 == b.d2 && a.triangle < b.triangle); });
  MeshTouches out;
  const double same = 1e-4 * radius;  // meshes from single-precision files have gaps of 1e-7 of their size
  for (int k = 0; k < n && out.count < kMaxTouches; ++k) {
    bool covered = false;
    for (int m = 0; m < k && !covered; ++m)
      covered =
          (near[m].point - near[k].point).squaredNorm() < same * same ||
          (nearest_on_triangle(triangles[static_cast<std::size_t>(near[m].triangle)], near[k].point) - near[k].point).squaredNorm() < same * same;
    if (covered || near[k].d2 == 0) continue;
    const double d = std::sqrt(near[k].d2);
    out.touch[out.count++] = {near[k].point, (near[k].point - centre) / d, d};
  }
  return out;
}
}  // namespace venato::dem
