#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>
namespace venato::graphics {

/// Maps p to h (p, 1), divided by its third component.
Eigen::Vector2d project(const Eigen::Matrix3d& h, const Eigen::Vector2d& p);
/// d project / d p.
Eigen::Matrix2d project_slope(const Eigen::Matrix3d& h, const Eigen::Vector2d& p);

/// Homography to_from_from with to[k] = project(h, from[k]); exact for four points, least squares of the distances in `to` for more
/// (direct linear transform on normalised points, then Gauss-Newton). \pre same sizes, at least 4
/// \return nothing when the points do not fix one (repeated, or all but one on a line)
/// Source: Hartley & Zisserman, Multiple View Geometry (2nd ed.), 4.1, 4.4.
std::optional<Eigen::Matrix3d> fit_homography(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to);
}  // namespace venato::graphics
