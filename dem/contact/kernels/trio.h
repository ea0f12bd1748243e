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
/// Part of a perpendicular to the unit vector n.
VENATO_KERNEL Trio across(const Trio& a, const Trio& n) { return a - dot(a, n) * n; }
inline Trio to_trio(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 to_vec3(const Trio& t) { return {t.x, t.y, t.z}; }

/// Rotation of a contact frame as a quaternion (cosine, vector) of any length: exact (length-preserving), without sines and with one division for
/// all vectors that it turns. \param scale 2 / (cosine^2 + |vector|^2); 0 turns nothing.
struct FrameTurn {
  Trio vector;
  double cosine = 0, scale = 0;
};
VENATO_KERNEL Trio rotate(const Trio& v, const FrameTurn& t) {
  const Trio a = cross(t.vector, v);
  return v + t.scale * (t.cosine * a + cross(t.vector, a));
}
/// Turn of the frame in one step: the normal from the direction of `from` to that of `to` by the shortest way, after which the frame spins by
/// `angle` = rate * dt about the (new) unit normal n, as the midpoint rule has it: tan(turn / 2) = angle / 2. With the half-step normal of
/// pair_frame() a pair that turns as one rigid body then keeps its springs exactly, whatever the step.
/// \param from_to |from| |to|
/// \return vector and cosine; the scale is left to the caller: (cosine^2 + |vector|^2) = 2 from_to cosine (1 + angle^2 / 4)
VENATO_KERNEL FrameTurn frame_turn(const Trio& from, const Trio& to, const Trio& n, double angle, double from_to) {
  FrameTurn t;
  const Trio shortest = cross(from, to);
  const double spin = 0.5 * angle;
  t.cosine = from_to + dot(from, to);
  t.vector = shortest + (spin * t.cosine) * n + spin * cross(n, shortest);  // product of the two quaternions; shortest . n = 0
  return t;
}
/// The same with its scale, where a division and a root more do not matter.
VENATO_KERNEL FrameTurn frame_turn(const Trio& from, const Trio& to, const Trio& n, double angle) {
  const double both = std::sqrt(dot(from, from) * dot(to, to));
  FrameTurn t = frame_turn(from, to, n, angle, both);
  t.scale = 1 / (both * t.cosine * (1 + 0.25 * angle * angle));
  return t;
}
}  // namespace venato::dem
