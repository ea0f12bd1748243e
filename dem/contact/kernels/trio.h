#pragma once
/// Three doubles for the contact kernels. Eigen's Vec3 stays the type of every interface; the kernels are compiled for several vector
/// widths, and plain scalars are what the compiler turns into lanes (expression templates are not).
#include <cmath>
#include "base/vec3.h"

namespace venato::dem {

#define VENATO_KERNEL [[gnu::always_inline]] inline

struct Trio {
  double x = 0, y = 0, z = 0;
  VENATO_KERNEL Trio() {}
  VENATO_KERNEL Trio(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  VENATO_KERNEL Trio(const Trio& o) : x(o.x), y(o.y), z(o.z) {}  // member by member: the vectoriser refuses block copies
  VENATO_KERNEL Trio& operator=(const Trio& o) {
    x = o.x, y = o.y, z = o.z;
    return *this;
  }
};
VENATO_KERNEL Trio operator+(const Trio& a, const Trio& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
VENATO_KERNEL Trio operator-(const Trio& a, const Trio& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
VENATO_KERNEL Trio operator-(const Trio& a) { return {-a.x, -a.y, -a.z}; }
VENATO_KERNEL Trio operator*(double s, const Trio& a) { return {s * a.x, s * a.y, s * a.z}; }
VENATO_KERNEL double dot(const Trio& a, const Trio& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
VENATO_KERNEL Trio cross(const Trio& a, const Trio& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
VENATO_KERNEL double length(const Trio& a) { return std::sqrt(dot(a, a)); }
/// The same with one rounding instead of two where a product is added (multiply-add), for the contact loop. Written out, so that every compiler and
/// every optimisation level rounds alike. A swap of the two grains of a pair changes signs and the places of i and j: signs commute with rounding,
/// but a_i b_i + a_j b_j has to stay as it is, or the two sides of a contact would differ in the last digit.
namespace fused {
VENATO_KERNEL double add(double s, double a, double b) { return __builtin_fma(s, a, b); }  ///< s a + b
VENATO_KERNEL Trio add(double s, const Trio& a, const Trio& b) { return {add(s, a.x, b.x), add(s, a.y, b.y), add(s, a.z, b.z)}; }
VENATO_KERNEL double dot(const Trio& a, const Trio& b) { return add(a.x, b.x, add(a.y, b.y, a.z * b.z)); }
VENATO_KERNEL Trio cross(const Trio& a, const Trio& b) { return {add(a.y, b.z, -(a.z * b.y)), add(a.z, b.x, -(a.x * b.z)), add(a.x, b.y, -(a.y * b.x))}; }
VENATO_KERNEL Trio across(const Trio& a, const Trio& n) { return fused::add(-fused::dot(a, n), n, a); }
}  // namespace fused
/// Part of a perpendicular to the unit vector n.
VENATO_KERNEL Trio across(const Trio& a, const Trio& n) { return a - dot(a, n) * n; }
inline Trio to_trio(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 to_vec3(const Trio& t) { return {t.x, t.y, t.z}; }

/// Turn of a contact frame in one step, for vectors across its normal: the shortest way from the old normal to the new one, v - (v . n) way, after
/// which the frame spins about the new one. Exact (length-preserving), without sines; what rounding left along the normal is taken out on the way.
struct FrameTurn {
  Trio way;                      ///< (n_before + n) / (1 + n_before . n)
  double cosine = 1, sine = 0;  ///< of the spin about n
};
/// `v` turned to lie across n, times `ratio`.
VENATO_KERNEL Trio turned(const Trio& v, const FrameTurn& t, const Trio& n, double ratio) {
  const Trio a = fused::add(-fused::dot(v, n), t.way, v);
  return fused::add(ratio * t.cosine, a, (ratio * t.sine) * fused::cross(n, a));
}
/// Turn of the frame from normal n_before to n with a spin of `angle` = rate * dt about n, as the midpoint rule has it: tan(turn / 2) = angle / 2. With
/// the half-step normal of pair_frame() a pair that turns as one rigid body then keeps its springs exactly, whatever the step. pair_frame() has the
/// same with fewer divisions.
VENATO_KERNEL FrameTurn frame_turn(const Trio& n_before, const Trio& n, double angle) {
  FrameTurn t;
  const double tangent = 0.5 * angle, over = 1 / (1 + tangent * tangent);
  t.way = (1 / (1 + dot(n_before, n))) * (n_before + n);
  t.cosine = (1 - tangent * tangent) * over, t.sine = 2 * tangent * over;
  return t;
}
}  // namespace venato::dem
