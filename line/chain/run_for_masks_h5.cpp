#include <map>

#include "base/error.h"
#include "base/h5/h5_file.h"
#include "base/io/sha256.h"
#include "line/chain/masks_of_run.h"
namespace venato::line {
namespace {
constexpr std::uint64_t kMaxSide = 1u << 20;

sync::Transform read_transform(const H5Reader& h5, const std::string& group) {
  const auto affine = h5.doubles(group + "/affine");
  if (affine.size() != 6) throw WorkError(group + "/affine is not 2 x 3");
  sync::Transform t;
  t.a << affine[0], affine[1], affine[3], affine[4];
  t.t = sync::Point(affine[2], affine[5]);
  const auto spline = group + "/spline_x";
  if (!h5.has(spline)) return t;
  const auto dims = h5.dims(spline);
  if (dims.size() != 2 || dims[0] > kMaxSide || dims[1] > kMaxSide) throw WorkError(spline + " has a wrong shape");
  t.u.ny = static_cast<int>(dims[0]);
  t.u.nx = static_cast<int>(dims[1]);
  t.u.cx = h5.doubles(spline);
  t.u.cy = h5.doubles(group + "/spline_y");
  t.u.spacing_m = h5.number_attribute(spline, "spacing_m");
  t.u.origin_m = sync::Point(h5.number_attribute(spline, "origin_x_m"), h5.number_attribute(spline, "origin_y_m"));
  if (t.u.cx.size() != t.u.cy.size()) throw WorkError(group + ": its splines differ in size");
  return t;
}

graphics::VeinMap read_vein_map(const H5Reader& h5, const LineConfig& c) {
  const auto dims = h5.dims("/vein_map/fraction");
  graphics::VeinMap map;
  for (const auto& powder : c.basics.powders) map.powders.push_back(powder.name);
  if (dims.size() != 3 || dims[2] != map.powders.size() || dims[0] > kMaxSide || dims[1] > kMaxSide)
    throw WorkError("/vein_map/fraction does not fit the powders of run.json");
  map.fraction = graphics::RasterF(static_cast<int>(dims[1]), static_cast<int>(dims[0]), static_cast<int>(dims[2]),
                                   h5.number_attribute("/vein_map/fraction", "pitch_m"));
  map.fraction.data = h5.floats("/vein_map/fraction");
  return map;
}

std::vector<FeedHead> read_heads(const H5Reader& h5) {
  std::map<double, FeedHead> by_position;
  const std::string prefix = "/commands/";
  for (const auto& name : h5.dataset_names()) {
    if (name.rfind(prefix, 0) != 0) continue;
    const auto dims = h5.dims(name);
    if (dims.size() != 2 || dims[0] > kMaxSide || dims[1] > kMaxSide) throw WorkError(name + " has a wrong shape");
    FeedHead h;
    h.name = name.substr(prefix.size());
    h.powder = h5.text_attribute(name, "powder");
    h.ticks = static_cast<int>(dims[0]);
    h.prongs = static_cast<int>(dims[1]);
    h.prong_pitch_m = h5.number_attribute(name, "prong_pitch_m");
    h.tick_s = h5.number_attribute(name, "tick_s");
    h.belt_speed_m_s = h5.number_attribute(name, "belt_speed_m_s");
    h.full_rate_kg_m2 = h5.number_attribute(name, "full_rate_kg_m2");
    h.duty = h5.doubles(name);
    by_position[h5.number_attribute(name, "position")] = std::move(h);
  }
  std::vector<FeedHead> heads;
  for (auto& [position, head] : by_position) heads.push_back(std::move(head));
  return heads;
}

void check_graphic(const H5Reader& h5, const LineConfig& c) {
  const auto hashes = h5.strings("/graphic/sha256");
  for (std::size_t k = 0; k < c.graphic.layers.size(); ++k)
    if (k >= hashes.size() || sha256_of_file(c.graphic.layers[k].image) != hashes[k])
      throw UsageError(c.graphic.layers[k].image.string() + ": has changed since the run; run the line again");
  if (!c.graphic.profile.empty() && h5.strings("/graphic/profile_sha256").at(0) != sha256_of_file(c.graphic.profile))
    throw UsageError(c.graphic.profile.string() + ": has changed since the run; run the line again");
}
}  // namespace

LineRun read_run_for_masks(const std::filesystem::path& run, const LineConfig& c) {
  const auto file = run / "run.h5";
  try {
    const H5Reader h5(file, "venato-run", 1);
    check_graphic(h5, c);
    LineRun out;
    out.vein_map = read_vein_map(h5, c);
    out.sync.registration.success = h5.number_attribute("/registration/print_from_green/affine", "success") != 0;
    out.sync.registration.print_from_green = read_transform(h5, "/registration/print_from_green");
    out.sync.nominal = read_transform(h5, "/registration/nominal");
    out.chain.state.commands.heads = read_heads(h5);
    return out;
  } catch (const WorkError& e) {
    throw UsageError(file.string() + ": " + e.what() + "; not of a finished run of this version: run the line again");
  }
}
}  // namespace venato::line
