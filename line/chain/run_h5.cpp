#include <algorithm>

#include "base/h5/h5_file.h"
#include "base/io/sha256.h"
#include "base/version.h"
#include "line/chain/run_line.h"
namespace venato::line {
namespace {
using Dims = std::vector<std::uint64_t>;

void raster(H5Writer& h5, const std::string& name, const graphics::RasterF& r, const std::string& units, const std::string& frame,
            const std::string& description, const std::string& channels = "channel") {
  if (r.empty()) return;
  Dims dims{static_cast<std::uint64_t>(r.height), static_cast<std::uint64_t>(r.width)};
  if (r.channels > 1) dims.push_back(static_cast<std::uint64_t>(r.channels));
  h5.dataset(name, r.data, dims, {units, r.channels > 1 ? "y,x," + channels : "y,x", frame, description});
  h5.attribute(name, "pitch_m", r.pitch_m);
}

std::string slug(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
}

void numbers(H5Writer& h5, const std::string& name, const std::vector<double>& data, const H5Meta& meta) {
  h5.dataset(name, data, {data.size()}, meta);
}

void write_operator_group(H5Writer& h5, const std::string& stage, const StageOperator& s) {
  const auto& op = s.op;
  const std::string group = "/stages/" + stage;
  h5.dataset(group + "/kernel", op.weight,
             {static_cast<std::uint64_t>(op.nz_in), static_cast<std::uint64_t>(op.nz_out), static_cast<std::uint64_t>(op.n_theta),
              static_cast<std::uint64_t>(op.n_eta)},
             {"1", "zeta_in,zeta_out,theta,eta", "belt", "share of an input layer's mass that arrives with this delay and shift"});
  h5.attribute(group + "/kernel", "theta0_s", op.theta0_s);
  h5.attribute(group + "/kernel", "dtheta_s", op.dtheta_s);
  h5.attribute(group + "/kernel", "eta0_m", op.eta0_m);
  h5.attribute(group + "/kernel", "deta_m", op.deta_m);
  h5.attribute(group + "/kernel", "reference_delay_s", op.reference_delay_s);
  h5.attribute(group + "/kernel", "store_key", s.key);
  std::vector<std::string> names;
  std::vector<double> values;
  for (const auto& [name, value] : op.figures) names.push_back(name), values.push_back(value);
  if (!names.empty()) {
    h5.strings(group + "/figure_names", names, {"1", "figure", "none", "names of the operator's figures; each ends in its SI unit"});
    numbers(h5, group + "/figure_values", values, {"SI", "figure", "none", "values of the operator's figures, in the unit its name ends in"});
  }
  for (const auto& [curve, columns] : op.curves)
    for (const auto& [column, data] : columns)
      if (!data.empty())
        numbers(h5, group + "/curves/" + slug(curve) + "/" + slug(column), data,
                {"SI", "sample", "none", curve + ": " + column + ", in the unit its name ends in"});
}

void write_residuals(H5Writer& h5, const std::string& name, const std::vector<sync::ResidualSample>& samples) {
  std::vector<double> data;
  for (const auto& s : samples) data.insert(data.end(), {s.x_m, s.y_m, s.signed_distance_m, s.matched ? 1.0 : 0.0});
  if (data.empty()) return;
  h5.dataset(name, data, {samples.size(), 4},
             {"m,m,m,1", "sample,(x;y;signed distance along the vein normal;matched)", "green",
              "centre-line residual of every sample of the print's veins"});
}

void write_transform(H5Writer& h5, const std::string& group, const sync::Transform& t, const std::string& what) {
  const std::vector<double> affine{t.a(0, 0), t.a(0, 1), t.t.x(), t.a(1, 0), t.a(1, 1), t.t.y()};
  h5.dataset(group + "/affine", affine, {2, 3}, {"1,1,m", "row,column", "print", what + ": print = A (green + u(green)) + t, rows of [A | t]"});
  if (t.u.spacing_m <= 0 || t.u.cx.empty()) return;
  const Dims dims{static_cast<std::uint64_t>(t.u.ny), static_cast<std::uint64_t>(t.u.nx)};
  h5.dataset(group + "/spline_x", t.u.cx, dims, {"m", "y,x", "green", "cubic B-spline coefficients of u, x part"});
  h5.dataset(group + "/spline_y", t.u.cy, dims, {"m", "y,x", "green", "cubic B-spline coefficients of u, y part"});
  h5.attribute(group + "/spline_x", "spacing_m", t.u.spacing_m);
  h5.attribute(group + "/spline_x", "origin_x_m", t.u.origin_m.x());
  h5.attribute(group + "/spline_x", "origin_y_m", t.u.origin_m.y());
}

/// Vein share of every cell, all layers: what cuts and polishing depths are made from.
void write_composition(H5Writer& h5, const Bed& bed, int body_powder) {
  const auto& g = bed.grid;
  const std::size_t cells = g.columns() * static_cast<std::size_t>(g.nz);
  std::vector<float> vein(cells, 0.0f);
  for (std::size_t c = 0; c < cells; ++c) {
    double total = 0;
    for (const auto& m : bed.mass) total += m[c];
    if (total > 0) vein[c] = static_cast<float>(1 - bed.mass[static_cast<std::size_t>(body_powder)][c] / total);
  }
  h5.dataset("/slab/vein_fraction", vein, {static_cast<std::uint64_t>(g.nz), static_cast<std::uint64_t>(g.ny), static_cast<std::uint64_t>(g.nx)},
             {"1", "zeta,y,x", "belt", "share of vein powder in every mass layer, bottom first, over the whole strip"});
  h5.attribute("/slab/vein_fraction", "pitch_m", g.pitch_m);
  h5.attribute("/slab/vein_fraction", "lead_m", g.lead_m);
  h5.dataset("/slab/areal_mass", bed.areal_mass(), {static_cast<std::uint64_t>(g.ny), static_cast<std::uint64_t>(g.nx)},
             {"kg/m2", "y,x", "belt", "moist powder per belt area"});
}
}  // namespace

void write_run_h5(const std::filesystem::path& file, const LineConfig& c, const LineRun& run) {
  H5Writer h5(file, "venato-run", 1);
  h5.attribute("/", "code_version", version_string());
  h5.attribute("/", "seed", std::to_string(c.basics.seed));
  h5.attribute("/", "config", c.resolved_json);
  raster(h5, "/plan/fraction", run.plan.fraction, "1", "design", "target share of each powder", "powder");
  h5.strings("/plan/powders", run.plan.powders, {"1", "powder", "none", "names of the powders in channel order"});
  double position = 0;  // of the head along the line; a file's groups are in alphabetical order
  for (const auto& h : run.chain.state.commands.heads) {
    const std::string name = "/commands/" + h.name;
    h5.dataset(name, h.duty, {static_cast<std::uint64_t>(h.ticks), static_cast<std::uint64_t>(h.prongs)},
               {"1", "tick,prong", "belt", "duty of dosing head " + h.name + ", powder " + h.powder});
    h5.attribute(name, "prong_pitch_m", h.prong_pitch_m);
    h5.attribute(name, "tick_s", h.tick_s);
    h5.attribute(name, "belt_speed_m_s", h.belt_speed_m_s);
    h5.attribute(name, "full_rate_kg_m2", h.full_rate_kg_m2);
    h5.attribute(name, "powder", h.powder);
    h5.attribute(name, "position", position++);
  }
  for (std::size_t s = 0; s < run.operators.size(); ++s) write_operator_group(h5, run.chain.stages[s].name, run.operators[s]);
  const auto& slab = run.slab();
  write_composition(h5, slab.bed, c.basics.body_powder);
  raster(h5, "/slab/thickness", slab.thickness_m, "m", "green", "pressed thickness");
  raster(h5, "/slab/density", slab.density_kg_m3, "kg/m3", "green", "pressed bulk density, moist");
  raster(h5, "/slab/pressure", slab.pressure_pa, "Pa", "green", "peak pressure");
  raster(h5, "/slab/belt_from_green", slab.belt_from_green_m, "m", "green", "belt position of each point of the cut slab", "(x;y)");
  numbers(h5, "/belt/layer_shift", run.layer_shift_m,
          {"m", "zeta", "belt", "mean displacement of vein powder along the belt per mass layer, without jitter; NaN: no vein powder there"});
  std::vector<double> jitter;
  for (int j = 0; j < c.basics.grid.ny; ++j) jitter.push_back(run.jitter.displacement_m((j + 0.5) * c.basics.grid.pitch_m));
  numbers(h5, "/belt/jitter", jitter, {"m", "y", "belt", "displacement along the belt between dosing and press, one value per row of the bed"});
  raster(h5, "/vein_map/fraction", run.vein_map.fraction, "1", "green", "share of each powder on the face or at the polishing depth", "powder");
  raster(h5, "/vein_map/std_error", run.vein_map.std_error, "1", "green",
         "standard error of the vein share, from bootstrap replicates of the operators");
  raster(h5, "/registration/print_vein_fraction", run.sync.print_fraction, "1", "print", "vein share of the graphic, as found by the plan's rule");
  write_transform(h5, "/registration/print_from_green", run.sync.registration.print_from_green,
                  run.sync.registration.success ? "registration" : "rejected registration, not used");
  h5.attribute("/registration/print_from_green/affine", "success", run.sync.registration.success ? 1.0 : 0.0);
  write_transform(h5, "/registration/nominal", run.sync.nominal, "file as designed");
  std::vector<std::string> hashes;
  for (const auto& layer : c.graphic.layers) hashes.push_back(sha256_of_file(layer.image));
  h5.strings("/graphic/sha256", hashes, {"1", "layer", "none", "SHA-256 of the picture of each layer of the graphic"});
  if (!c.graphic.profile.empty())
    h5.strings("/graphic/profile_sha256", {sha256_of_file(c.graphic.profile)}, {"1", "profile", "none", "SHA-256 of the ICC profile of the printer"});
  raster(h5, "/registration/sigma", run.sync.registration.sigma_m, "m", "green", "predicted error of the registration");
  write_residuals(h5, "/residuals/before", run.sync.residuals_before);
  write_residuals(h5, "/residuals/after", run.sync.residuals_after);
  write_residuals(h5, "/residuals/best_reachable", run.sync.residuals_best);
  h5.close();
}
}  // namespace venato::line
