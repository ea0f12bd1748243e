#include "line/chain/exact_map.h"

#include <algorithm>
#include <cmath>

#include "base/expects.h"
#include "line/chain/pictures.h"
#include "line/commands/deposit_head.h"
namespace venato::line {
namespace {

struct Centroid {
  double mass, y_m;
};
/// Centroid along the belt of one powder in one layer, the endless strip unrolled about y0.
Centroid centroid(const Bed& bed, std::size_t powder, int layer, double y0_m) {
  const auto& g = bed.grid;
  const auto nx = static_cast<std::size_t>(g.nx), ny = static_cast<std::size_t>(g.ny);
  const double length = g.ny * g.pitch_m;
  double mass = 0, moment = 0;
  for (std::size_t j = 0; j < ny; ++j) {
    double row = 0;
    for (std::size_t i = 0; i < nx; ++i) row += bed.mass[powder][(static_cast<std::size_t>(layer) * ny + j) * nx + i];
    double dy = (static_cast<double>(j) + 0.5) * g.pitch_m - y0_m;
    dy -= std::round(dy / length) * length;
    mass += row;
    moment += row * dy;
  }
  return {mass, mass > 0 ? y0_m + moment / mass : kUnset};
}

/// Commands with one tick of all vein prongs on. Body heads with the same layout give way where the vein lies, others stay as over a plain bed.
FeedCommands probe_commands(const FeedCommands& commands, const std::string& vein) {
  FeedCommands probe = commands;
  const FeedHead* reference = nullptr;
  int tick = 0;
  for (auto& h : probe.heads) {
    if (h.powder != vein) continue;
    reference = &h;
    tick = h.ticks / 2;
    std::fill(h.duty.begin(), h.duty.end(), 0.0);
    std::fill_n(h.duty.begin() + static_cast<std::ptrdiff_t>(tick) * h.prongs, h.prongs, 1.0);
  }
  VENATO_EXPECTS(reference != nullptr);
  for (auto& h : probe.heads) {
    if (h.powder == vein || h.duty.empty()) continue;
    const double plain = *std::max_element(h.duty.begin(), h.duty.end());  // over body only: the lead-in has no vein
    std::fill(h.duty.begin(), h.duty.end(), plain);
    if (h.ticks == reference->ticks && h.prongs == reference->prongs)
      std::fill_n(h.duty.begin() + static_cast<std::ptrdiff_t>(tick) * h.prongs, h.prongs,
                  std::max(0.0, plain - reference->full_rate_kg_m2 / h.full_rate_kg_m2));
  }
  return probe;
}
}  // namespace

std::vector<double> layer_shifts(const LineConfig& config, const LineBasics& basics, const std::vector<Operator>& operators,
                                 const FeedCommands& commands, Context& context) {
  const std::string& vein = basics.powders[static_cast<std::size_t>(basics.vein_powder)].name;
  const auto probe = probe_commands(commands, vein);
  std::vector<std::string> powders;
  for (const auto& p : basics.powders) powders.push_back(p.name);
  // Where the pulse lies when nothing moves it, on this very grid: a tick shorter than a cell does not sit in the cell's middle.
  Bed laid = make_bed(basics.grid, powders);
  for (const auto& h : probe.heads)
    if (h.powder == vein) deposit_head(h, laid);
  const double y0 = centroid(laid, static_cast<std::size_t>(basics.vein_powder), 0, basics.grid.ny * basics.grid.pitch_m / 2).y_m;

  ApplyOptions options;
  options.before_press_only = true;
  const auto result = apply_chain(config, basics, operators, probe, JitterField{}, options, context);
  VENATO_EXPECTS(result.state.bed.has_value());
  const Bed& bed = *result.state.bed;
  const auto powder = static_cast<std::size_t>(std::find(bed.powders.begin(), bed.powders.end(), vein) - bed.powders.begin());
  std::vector<double> shifts;
  for (int z = 0; z < bed.grid.nz; ++z) shifts.push_back(centroid(bed, powder, z, y0).y_m - y0);
  return shifts;
}

double sample_bilinear(const graphics::RasterF& r, double x_m, double y_m, int channel) {
  const double x = std::clamp(x_m / r.pitch_m - 0.5, 0.0, r.width - 1.0), y = std::clamp(y_m / r.pitch_m - 0.5, 0.0, r.height - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(0, r.width - 2)), j = std::min(static_cast<int>(y), std::max(0, r.height - 2));
  const int i1 = std::min(i + 1, r.width - 1), j1 = std::min(j + 1, r.height - 1);
  const double fx = x - i, fy = y - j;
  const auto v = [&](int a, int b) { return static_cast<double>(r.at(a, b, channel)); };
  return (v(i, j) * (1 - fx) + v(i1, j) * fx) * (1 - fy) + (v(i, j1) * (1 - fx) + v(i1, j1) * fx) * fy;
}

sync::Point ExactMap::operator()(sync::Point p) const {
  const auto& b = config->basics;
  const double x = sample_bilinear(*belt_from_green_m, p.x(), p.y(), 0), y_press = sample_bilinear(*belt_from_green_m, p.x(), p.y(), 1);
  const double y = jitter.undo(y_press) - shift_y_m;
  const double print_from_belt = b.print_from_design() / b.belt_from_design();
  return placement(sync::Point(x - b.trim_m, y - b.grid.lead_m) * print_from_belt);
}

ExactMap make_exact_map(const LineConfig& config, const Slab& slab, const JitterField& jitter, const std::vector<double>& shifts, double zeta) {
  ExactMap map{&config, &slab.belt_from_green_m, jitter, 0, placement_transform(config)};
  // Layer centres at (z + 1/2) / nz; linear between them. Layers without vein powder do not count.
  const double position = std::clamp(zeta * static_cast<double>(shifts.size()) - 0.5, 0.0, static_cast<double>(shifts.size()) - 1);
  const auto low = static_cast<std::size_t>(position), high = std::min(low + 1, shifts.size() - 1);
  const double f = position - static_cast<double>(low);
  const double a = shifts[low], b = shifts[high];
  map.shift_y_m = std::isfinite(a) && std::isfinite(b) ? a * (1 - f) + b * f : std::isfinite(a) ? a : std::isfinite(b) ? b : 0.0;
  return map;
}

graphics::Raster8 exact_mask_on_green(const graphics::RasterF& print_fraction, const ExactMap& map, int width, int height, double pitch_m,
                                      float threshold) {
  graphics::Raster8 mask(width, height, 1, pitch_m, std::uint8_t{0});
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const auto q = map({(i + 0.5) * pitch_m, (j + 0.5) * pitch_m});
      const bool inside = q.x() >= 0 && q.y() >= 0 && q.x() < print_fraction.width_m() && q.y() < print_fraction.height_m();
      if (inside && sample_bilinear(print_fraction, q.x(), q.y(), 0) > static_cast<double>(threshold)) mask.at(i, j) = 255;
    }
  return mask;
}

MapError compare_with_exact(const sync::Transform& print_from_green, const ExactMap& map, const graphics::Raster8& mask) {
  std::vector<double> errors;
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i)
      if (mask.at(i, j)) {
        const sync::Point p((i + 0.5) * mask.pitch_m, (j + 0.5) * mask.pitch_m);
        errors.push_back((print_from_green(p) - map(p)).norm());
      }
  if (errors.empty()) return {kUnset, kUnset};
  std::sort(errors.begin(), errors.end());
  const auto quantile = [&](double u) { return errors[static_cast<std::size_t>(std::lround(u * static_cast<double>(errors.size() - 1)))]; };
  return {quantile(0.5), quantile(0.95)};
}
}  // namespace venato::line
