#include "line/projection/flux_profile.h"

#include <string>

#include "base/error.h"
#include "base/expects.h"

namespace venato::line {
namespace {
constexpr int kPointsPerCell = 16;
constexpr double kOffLine = 1e-6;  // of a cell: decides the cell of a point that lies on a cell face
}  // namespace

double FluxProfile::position_at(double quantile) const {
  const auto upper = std::upper_bound(cumulated.begin() + 1, cumulated.end() - 1, quantile);
  const double high = *upper, low = *(upper - 1), width = high - low;
  const double cell = static_cast<double>(upper - 1 - cumulated.begin()) + (width > 0 ? std::clamp((quantile - low) / width, 0.0, 1.0) : 0.5);
  return cell * length_m / static_cast<double>(cumulated.size() - 1);
}

double FluxProfile::quantile_at(double distance_m) const {
  const double at = std::clamp(distance_m / length_m, 0.0, 1.0) * static_cast<double>(cumulated.size() - 1);
  const std::size_t cell = std::min(static_cast<std::size_t>(at), cumulated.size() - 2);
  return cumulated[cell] + (cumulated[cell + 1] - cumulated[cell]) * (at - static_cast<double>(cell));
}

FluxProfile flux_profile(const GridField& field, const Segment& segment, SegmentRole role) {
  FluxProfile profile;
  profile.segment = segment;
  const double dy = segment.y1_m - segment.y0_m, dz = segment.z1_m - segment.z0_m;
  profile.length_m = std::hypot(dy, dz);
  const std::string name = role == SegmentRole::inlet ? "inlet" : "outlet";
  if (!(profile.length_m > 0)) throw UsageError(name + " of the projection has no length");
  profile.along_y = dy / profile.length_m;
  profile.along_z = dz / profile.length_m;
  const int n = std::max(64, static_cast<int>(std::ceil(kPointsPerCell * profile.length_m / field.cell_m())));

  const auto fluxes = [&](double normal_y, double normal_z) {
    std::vector<double> flux(static_cast<std::size_t>(n), 0.0);
    const double off = (role == SegmentRole::inlet ? kOffLine : -kOffLine) * field.cell_m();
    for (int k = 0; k < n; ++k) {
      const double s = (k + 0.5) / n * profile.length_m;
      const double y = segment.y0_m + s * profile.along_y + off * normal_y, z = segment.z0_m + s * profile.along_z + off * normal_z;
      if (!field.inside(field.column_of(y), field.row_of(z))) continue;
      const auto here = field.sample(y, z);
      flux[static_cast<std::size_t>(k)] = here.phi * (here.u_y * normal_y + here.u_z * normal_z) * profile.length_m / n;
    }
    return flux;
  };
  const auto sum = [](const std::vector<double>& v, bool forward_only) {
    double s = 0;
    for (double f : v) s += forward_only ? std::max(0.0, f) : f;
    return s;
  };
  // Either normal could be downstream; on a border only one of them looks at powder, so try both and keep the one with the larger forward flow.
  double best = 0;
  std::vector<double> flux;
  for (const double side : {1.0, -1.0}) {
    const double ny = side * profile.along_z, nz = -side * profile.along_y;
    std::vector<double> f = fluxes(ny, nz);
    if (sum(f, false) > best) {
      best = sum(f, false);
      profile.normal_y = ny;
      profile.normal_z = nz;
      flux = std::move(f);
    }
  }
  if (!(best > 0))
    throw WorkError("no powder flows through the " + name + " from (" + std::to_string(segment.y0_m) + ", " + std::to_string(segment.z0_m) +
                    ") to (" + std::to_string(segment.y1_m) + ", " + std::to_string(segment.z1_m) +
                    ") m in the measured fields; the window is empty there or at rest");
  profile.net_m2_s = best;
  const double forward = sum(flux, true);
  profile.cumulated.assign(1, 0.0);
  for (double f : flux) profile.cumulated.push_back(profile.cumulated.back() + std::max(0.0, f) / forward);
  profile.cumulated.back() = 1;
  return profile;
}
}  // namespace venato::line
