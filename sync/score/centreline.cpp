#include "sync/score/centreline.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include "sync/score/distance.h"
#include "sync/score/sample.h"
namespace venato::sync {
namespace {
constexpr int kDirectionSteps = 5;  // skeleton pixels each way that give the direction: two vein widths of a thin vein
constexpr int kAverageSteps = 2;    // each way: averages the staircase of a binary edge
constexpr double kProfileStep_px = 0.25;
constexpr double kSpurMargin_px = 1.5;

struct Skeleton {
  int width = 0;
  std::vector<int> pixels;             ///< linear index of each node
  std::vector<int> node;               ///< node number of a pixel, -1
  std::vector<std::vector<int>> near;  ///< neighbours of a node; a diagonal one only if no orthogonal detour exists
};

Skeleton graph(const graphics::Raster8& thin) {
  Skeleton s;
  s.width = thin.width;
  s.node.assign(thin.data.size(), -1);
  for (std::size_t k = 0; k < thin.data.size(); ++k)
    if (thin.data[k]) {
      s.node[k] = static_cast<int>(s.pixels.size());
      s.pixels.push_back(static_cast<int>(k));
    }
  s.near.resize(s.pixels.size());
  const auto set = [&](int i, int j) { return i >= 0 && j >= 0 && i < thin.width && j < thin.height && thin.at(i, j); };
  for (std::size_t n = 0; n < s.pixels.size(); ++n) {
    const int i = s.pixels[n] % thin.width, j = s.pixels[n] / thin.width;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || !set(i + dx, j + dy)) continue;
        if (dx != 0 && dy != 0 && (set(i + dx, j) || set(i, j + dy))) continue;
        s.near[n].push_back(s.node[static_cast<std::size_t>((j + dy) * thin.width + i + dx)]);
      }
  }
  return s;
}

/// Cuts branches that end freely after no more pixels than the vein's half width at their junction: Zhang-Suen grows them from rough edges.
graphics::Raster8 prune(const graphics::Raster8& thin, const graphics::RasterF& depth_px) {
  graphics::Raster8 out = thin;
  const Skeleton s = graph(thin);
  for (std::size_t n = 0; n < s.pixels.size(); ++n) {
    if (s.near[n].size() != 1) continue;
    std::vector<int> path = {static_cast<int>(n)};
    int before = -1, here = static_cast<int>(n);
    while (s.near[static_cast<std::size_t>(here)].size() <= 2) {
      int next = -1;
      for (const int m : s.near[static_cast<std::size_t>(here)])
        if (m != before) next = m;
      if (next < 0) break;
      before = here;
      here = next;
      path.push_back(here);
      if (path.size() > 200) break;
    }
    const auto end = static_cast<std::size_t>(here);
    if (s.near[end].size() < 3) continue;  // an isolated line is a vein, however short
    const auto depth = static_cast<double>(depth_px.data[static_cast<std::size_t>(s.pixels[end])]);
    if (static_cast<double>(path.size() - 1) > depth + kSpurMargin_px) continue;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) out.data[static_cast<std::size_t>(s.pixels[static_cast<std::size_t>(path[k])])] = 0;
  }
  return out;
}

std::vector<int> within(const Skeleton& s, int start, int steps) {
  std::vector<int> found = {start}, front = {start};
  for (int k = 0; k < steps; ++k) {
    std::vector<int> next;
    for (const int n : front)
      for (const int m : s.near[static_cast<std::size_t>(n)])
        if (std::find(found.begin(), found.end(), m) == found.end()) {
          found.push_back(m);
          next.push_back(m);
        }
    front.swap(next);
  }
  return found;
}

/// 3 x 3 binomial smoothing of the mask, 0..1: takes the staircase out of its edges without closing gaps.
graphics::RasterF softened(const graphics::Raster8& mask) {
  graphics::RasterF out(mask.width, mask.height, 1, mask.pitch_m);
  const float weight[3] = {0.25f, 0.5f, 0.25f};
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i) {
      float sum = 0;
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (mask.at(std::clamp(i + x, 0, mask.width - 1), std::clamp(j + y, 0, mask.height - 1))) sum += weight[x + 1] * weight[y + 1];
      out.at(i, j) = sum;
    }
  return out;
}

struct Centre {
  Point px;
  double width_px = 0;
};

/// Middle between the two half-height edges across the vein.
Centre middle(const graphics::RasterF& soft, Point px, Point normal, double reach_px) {
  const double half = 0.5 * std::min(1.0, bilinear(soft, px));
  double edge[2] = {0, 0};
  double area = 0;  // of the profile = width of the vein, which the smoothing leaves alone
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? -1 : 1;
    double before = bilinear(soft, px);
    edge[side] = sign * reach_px;
    bool outside = false;
    for (double r = kProfileStep_px; r <= reach_px; r += kProfileStep_px) {
      const double value = bilinear(soft, px + sign * r * normal);
      if (outside && value > before) break;  // the next vein begins
      area += kProfileStep_px * (value + before) / 2;
      if (!outside && value < half) {
        edge[side] = sign * (r - kProfileStep_px * (half - value) / (before - value));
        outside = true;
      }
      before = value;
    }
  }
  return {px + 0.5 * (edge[0] + edge[1]) * normal, area};
}
}  // namespace

std::vector<CentreLink> centre_links(const graphics::Raster8& mask, double min_width_m) {
  std::vector<CentreLink> out;
  if (mask.empty()) return out;
  graphics::Raster8 outside = mask;
  for (std::uint8_t& v : outside.data) v = v ? 0 : 255;
  const graphics::RasterF depth = distance_to(outside), soft = softened(mask);
  const Skeleton s = graph(prune(skeleton(mask), depth));
  const auto pixel = [&](int n) { return Point(s.pixels[static_cast<std::size_t>(n)] % s.width, s.pixels[static_cast<std::size_t>(n)] / s.width); };
  std::vector<Centre> centres(s.pixels.size()), averaged(s.pixels.size());
  for (std::size_t n = 0; n < s.pixels.size(); ++n) {
    const Point here = pixel(static_cast<int>(n));
    const std::vector<int> chain = within(s, static_cast<int>(n), kDirectionSteps);
    Point mean = Point::Zero();
    for (const int m : chain) mean += pixel(m) / static_cast<double>(chain.size());
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const int m : chain) spread += (pixel(m) - mean) * (pixel(m) - mean).transpose();
    const Point normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
    // Where the middle would lie further away than the skeleton can be off, the profile has run into a junction or a neighbour: keep the pixel.
    const double depth_px = std::min(1e4, static_cast<double>(depth.data[static_cast<std::size_t>(s.pixels[n])]));
    const Centre found = chain.size() > 1 ? middle(soft, here, normal, 2 * depth_px + 2) : Centre{here, 2 * depth_px - 1};
    centres[n] = (found.px - here).norm() <= 1.5 ? found : Centre{here, 2 * depth_px - 1};
  }
  for (std::size_t n = 0; n < s.pixels.size(); ++n) {
    const std::vector<int> chain = within(s, static_cast<int>(n), kAverageSteps);
    // A full chain is symmetric; near ends and junctions the average would slide along or off the line.
    averaged[n] = centres[n];
    if (chain.size() != 2 * kAverageSteps + 1 || s.near[n].size() != 2) continue;
    averaged[n].px = Point::Zero();
    for (const int m : chain) averaged[n].px += centres[static_cast<std::size_t>(m)].px / static_cast<double>(chain.size());
  }
  const Point half(0.5, 0.5);
  for (std::size_t n = 0; n < s.pixels.size(); ++n)
    for (const int m : s.near[n]) {
      if (m <= static_cast<int>(n)) continue;
      const Centre &a = averaged[n], &b = averaged[static_cast<std::size_t>(m)];
      const double width_m = (a.width_px + b.width_px) / 2 * mask.pitch_m;
      if (width_m < min_width_m) continue;
      out.push_back(
          {(a.px + half) * mask.pitch_m, (b.px + half) * mask.pitch_m, (pixel(static_cast<int>(n)) - pixel(m)).norm() * mask.pitch_m, width_m});
    }
  return out;
}
}  // namespace venato::sync
