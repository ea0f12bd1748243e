#include "dem/fields/continuum_h5.h"

namespace venato::dem {
namespace {
const char* const kFrame = "dem";
using Dims = std::vector<std::uint64_t>;

std::vector<double> flat(const std::vector<Vec3>& field) {
  std::vector<double> out;
  out.reserve(3 * field.size());
  for (const Vec3& v : field) out.insert(out.end(), {v.x(), v.y(), v.z()});
  return out;
}
std::vector<double> flat(const std::vector<std::array<double, 9>>& field) {
  std::vector<double> out;
  out.reserve(9 * field.size());
  for (const auto& t : field) out.insert(out.end(), t.begin(), t.end());
  return out;
}

void write_continuum(H5Writer& file, const std::string& group, const ContinuumFields& f) {
  static constexpr const char* kAxisName[] = {"x_m", "y_m", "z_m"};
  static constexpr const char* kAxis[] = {"x", "y", "z"};
  for (int a = 0; a < 3; ++a) {
    std::vector<double> centre;
    for (int k = 0; k < f.grid.n[static_cast<std::size_t>(a)]; ++k) centre.push_back(f.grid.centre_m(a, k));
    file.dataset(group + kAxisName[a], centre, {centre.size()},
                 {"m", kAxis[a], kFrame, f.grid.resolved(a) ? "centres of the cells" : "one cell: averaged over the box along this direction"});
  }
  const Dims n{static_cast<std::uint64_t>(f.grid.n[2]), static_cast<std::uint64_t>(f.grid.n[1]), static_cast<std::uint64_t>(f.grid.n[0])};
  const auto with = [&](std::initializer_list<std::uint64_t> more) {
    Dims d = n;
    d.insert(d.end(), more);
    return d;
  };
  const auto scalar = [&](const char* name, const std::vector<double>& data, const char* units, const char* what) {
    file.dataset(group + name, data, n, {units, "z,y,x", kFrame, what});
  };
  const auto vector = [&](const char* name, const std::vector<Vec3>& data, const char* units, const char* what) {
    file.dataset(group + name, flat(data), with({3}), {units, "z,y,x,xyz", kFrame, what});
  };
  const auto tensor = [&](const char* name, const std::vector<std::array<double, 9>>& data, const char* units, const char* what) {
    file.dataset(group + name, flat(data), with({3, 3}), {units, "z,y,x,row,column", kFrame, what});
  };
  scalar("density_kg_m3", f.density_kg_m3, "kg/m3", "mass of grains per volume");
  scalar("solid_fraction", f.solid_fraction, "1", "volume of grains per volume");
  vector("momentum_kg_m2_s", f.momentum_kg_m2_s, "kg/(m2 s)", "momentum of grains per volume");
  vector("velocity_m_s", f.velocity_m_s, "m/s", "momentum over density; NaN where there is no mass");
  tensor("velocity_gradient_1_s", f.gradient_1_s, "1/s", "gradient of the best affine flow in the kernel: row = velocity, column = direction");
  scalar("temperature_m2_s2", f.temperature_m2_s2, "m2/s2", "granular temperature <v'v'>/3 about the best affine flow in the kernel");
  tensor("kinetic_stress_pa", f.kinetic_stress_pa, "Pa",
         "kinetic stress about the cell's mean velocity, tension positive: row = momentum, column = face");
  tensor("contact_stress_pa", f.contact_stress_pa, "Pa", "contact stress, tension positive: row = force, column = face");
  std::vector<double> pressure;
  for (std::size_t c = 0; c < f.grid.size(); ++c) pressure.push_back(f.pressure_pa(c));
  scalar("pressure_pa", pressure, "Pa", "minus a third of the trace of both stresses");
  vector("wall_force_n_m3", f.wall_force_n_m3, "N/m3", "force of walls and frozen grains on the grains, per volume");
  scalar("grains", f.grains, "1", "grain-frames that carry the cell, (sum m)^2 / sum m^2; read the temperature where it is well above 4");
}

void write_plateau(H5Writer& file, const std::string& group, const PlateauScan& p) {
  const Dims n{p.width_m.size()};
  file.dataset(group + "z_m", std::vector<double>{p.z_m}, {}, {"m", "", kFrame, "height of the scan: mean height of the grains' mass"});
  file.dataset(group + "width_m", p.width_m, n, {"m", "width", "none", "widths of the kernel (standard deviation)"});
  file.dataset(group + "density_kg_m3", p.density_kg_m3, n, {"kg/m3", "width", "none", "density there, mean over x and y"});
  file.dataset(group + "stress_zz_pa", p.stress_zz_pa, n, {"Pa", "width", "none", "vertical stress there, kinetic + contact, tension positive"});
  file.dataset(group + "temperature_m2_s2", p.temperature_m2_s2, n, {"m2/s2", "width", "none", "granular temperature there"});
}

void write_diffusivity(H5Writer& file, const std::string& group, const WindowFields& w) {
  std::vector<double> y, z;
  for (int i = 0; i < w.grid.ny; ++i) y.push_back(w.grid.y0_m + (i + 0.5) * w.grid.cell_m);
  for (int j = 0; j < w.grid.nz; ++j) z.push_back(w.grid.z0_m + (j + 0.5) * w.grid.cell_m);
  file.dataset(group + "y_m", y, {y.size()}, {"m", "y", kFrame, "centres of the cells"});
  file.dataset(group + "z_m", z, {z.size()}, {"m", "z", kFrame, "centres of the cells"});
  const Dims n{z.size(), y.size()};
  const auto field = [&](const char* name, const std::vector<double>& data, const char* units, const char* what) {
    file.dataset(group + name, data, n, {units, "z,y", kFrame, what});
  };
  field("d_xx_m2_s", w.d_xx_m2_s, "m2/s", "diffusivity across, divided by the square of the coarse graining");
  field("d_yy_m2_s", w.d_yy_m2_s, "m2/s", "diffusivity along the belt");
  field("d_zz_m2_s", w.d_zz_m2_s, "m2/s", "diffusivity upwards");
  field("d_yz_m2_s", w.d_yz_m2_s, "m2/s", "diffusivity, mixed term");
  field("samples", w.samples, "1", "grain-frames; cells with fewer than 50 are masked (0)");
  file.dataset(group + "lag_s", std::vector<double>{w.lag_s}, {},
               {"s", "", "none", "lag of the displacements: the smallest within 5 % of the plateau"});
}
}  // namespace

void write_fields(H5Writer& file, const std::string& group, const FieldResult& r) {
  const auto scalar = [&](const char* name, double value, const char* units, const char* what) {
    file.dataset(group + name, std::vector<double>{value}, {}, {units, "", "none", what});
  };
  scalar("width_m", r.fields.grid.width_m, "m", "width of the kernel: its standard deviation along each axis, a third of its reach");
  scalar("frames", static_cast<double>(r.fields.frames), "1", "instants averaged");
  scalar("balance_residual", r.balance_residual, "1",
         "last frame: largest of |force on grains - div stress - weight - wall force| over all cells, over the largest of these terms");
  write_continuum(file, group, r.fields);
  write_plateau(file, group + "plateau/", r.plateau);
  if (r.diffusivity) write_diffusivity(file, group + "diffusivity/", *r.diffusivity);
}
}  // namespace venato::dem
