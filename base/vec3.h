#pragma once
#include <Eigen/Core>
namespace venato {
/// Three doubles in SI units; the frame stands in the variable's name (x across the belt, y along it, z up).
using Vec3 = Eigen::Vector3d;
}  // namespace venato
