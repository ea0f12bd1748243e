#include "dem/fields/mean_flow.h"

#include <cmath>

namespace venato::dem {
namespace {
/// y of `y_m` moved by whole periods next to `near` (grids that span one period), otherwise as it is.
double next_to(double y_m, double near, const FieldGrid& grid, bool periodic) {
  if (!periodic) return y_m;
  const double period = grid.ny * grid.cell_m;
  return y_m - period * std::round((y_m - near) / period);
}

void add_gradients(MeanFlow& flow, const FieldGrid& grid, bool periodic) {
  const std::size_t n = grid.size();
  for (auto* g : {&flow.uy_y, &flow.uy_z, &flow.uz_y, &flow.uz_z}) g->assign(n, 0);
  const auto neighbour = [&](int i, int j) -> std::optional<std::size_t> {
    if (periodic) i = (i + grid.ny) % grid.ny;
    if (i < 0 || i >= grid.ny || j < 0 || j >= grid.nz) return std::nullopt;
    const std::size_t c = grid.index(i, j);
    return flow.known(c) ? std::optional(c) : std::nullopt;
  };
  for (int j = 0; j < grid.nz; ++j)
    for (int i = 0; i < grid.ny; ++i) {
      const std::size_t c = grid.index(i, j);
      if (!flow.known(c)) continue;
      const std::size_t west = neighbour(i - 1, j).value_or(c), east = neighbour(i + 1, j).value_or(c);
      const std::size_t below = neighbour(i, j - 1).value_or(c), above = neighbour(i, j + 1).value_or(c);
      const double dy = next_to(flow.y_m[east], flow.y_m[c], grid, periodic) - next_to(flow.y_m[west], flow.y_m[c], grid, periodic);
      const double dz = flow.z_m[above] - flow.z_m[below];
      // Samples may crowd at the common edge of two cells; a slope over less than half a cell would only be noise.
      if (dy > 0.5 * grid.cell_m) {
        flow.uy_y[c] = (flow.u_y_m_s[east] - flow.u_y_m_s[west]) / dy;
        flow.uz_y[c] = (flow.u_z_m_s[east] - flow.u_z_m_s[west]) / dy;
      }
      if (dz > 0.5 * grid.cell_m) {
        flow.uy_z[c] = (flow.u_y_m_s[above] - flow.u_y_m_s[below]) / dz;
        flow.uz_z[c] = (flow.u_z_m_s[above] - flow.u_z_m_s[below]) / dz;
      }
    }
}
}  // namespace

MeanFlow mean_flow(const Tracks& tracks, std::span<const double> times_s, std::span<const double> frame_weights, const FieldGrid& grid,
                   bool periodic_y, double min_samples) {
  const GridLookup lookup(grid, periodic_y);
  const std::size_t n = grid.size();
  MeanFlow flow;
  for (auto* v : {&flow.u_y_m_s, &flow.u_z_m_s, &flow.y_m, &flow.z_m, &flow.samples, &flow.weight}) v->assign(n, 0);
  std::vector<double> mass(n, 0);
  const auto cell_centre_y = [&](std::size_t c) {
    return grid.y0_m + (static_cast<double>(c % static_cast<std::size_t>(grid.ny)) + 0.5) * grid.cell_m;
  };
  for (std::size_t p = 0; p < tracks.count(); ++p)
    for (std::size_t e = tracks.start[p]; e + 1 < tracks.start[p + 1]; ++e) {
      const std::size_t f = static_cast<std::size_t>(tracks.first_frame[p]) + e - tracks.start[p];
      const Vec3 mid = 0.5 * (tracks.position_m[e] + tracks.position_m[e + 1]), step = tracks.position_m[e + 1] - tracks.position_m[e];
      const auto c = lookup.cell(mid.y(), mid.z());
      if (!c) continue;
      flow.samples[*c] += 1;
      const double m = tracks.volume_m3[p] * frame_weights[f];
      flow.u_y_m_s[*c] += m * step.y();
      flow.u_z_m_s[*c] += m * step.z();
      flow.weight[*c] += m * (times_s[f + 1] - times_s[f]);
      mass[*c] += m;
      flow.y_m[*c] += m * next_to(mid.y(), cell_centre_y(*c), grid, periodic_y);
      flow.z_m[*c] += m * mid.z();
    }
  for (std::size_t c = 0; c < n; ++c) {
    if (flow.samples[c] < min_samples || !(flow.weight[c] > 0)) {
      flow.u_y_m_s[c] = flow.u_z_m_s[c] = flow.y_m[c] = flow.z_m[c] = flow.weight[c] = 0;
      continue;
    }
    flow.u_y_m_s[c] /= flow.weight[c];
    flow.u_z_m_s[c] /= flow.weight[c];
    flow.y_m[c] /= mass[c];
    flow.z_m[c] /= mass[c];
  }
  add_gradients(flow, grid, periodic_y);
  return flow;
}

IntegratedFlow integrated_flow(const Tracks& tracks, std::span<const double> times_s, const MeanFlow& flow, const FieldGrid& grid, bool periodic_y) {
  const GridLookup lookup(grid, periodic_y);
  IntegratedFlow sum{std::vector<Vec3>(tracks.position_m.size(), Vec3::Zero()), std::vector<std::int32_t>(tracks.position_m.size(), 0)};
  for (std::size_t p = 0; p < tracks.count(); ++p)
    for (std::size_t e = tracks.start[p]; e + 1 < tracks.start[p + 1]; ++e) {
      const std::size_t f = static_cast<std::size_t>(tracks.first_frame[p]) + e - tracks.start[p];
      const Vec3 mid = 0.5 * (tracks.position_m[e] + tracks.position_m[e + 1]);
      const auto c = lookup.cell(mid.y(), mid.z());
      sum.displacement_m[e + 1] = sum.displacement_m[e];
      sum.unknown[e + 1] = sum.unknown[e];
      if (!c || !flow.known(*c)) {
        ++sum.unknown[e + 1];
        continue;
      }
      const double dy = next_to(mid.y(), flow.y_m[*c], grid, periodic_y) - flow.y_m[*c], dz = mid.z() - flow.z_m[*c];
      const Vec3 u(0, flow.u_y_m_s[*c] + flow.uy_y[*c] * dy + flow.uy_z[*c] * dz, flow.u_z_m_s[*c] + flow.uz_y[*c] * dy + flow.uz_z[*c] * dz);
      sum.displacement_m[e + 1] += (times_s[f + 1] - times_s[f]) * u;
    }
  return sum;
}
}  // namespace venato::dem
