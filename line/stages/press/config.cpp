#include "line/stages/press/config.h"

namespace venato::line::press {

void read(ObjectReader& r, Config& c) {
  r.number("peak_pressure_mpa", c.peak_pressure_pa, {5, 60, "MPa", "press rating"}, {.help = "mean peak pressure", .fallback = 39.2});
  r.number(
      "density_at_1_mpa_kg_m3", c.density_a_kg_m3, {500, 2500, "kg/m3"},
      {.help = "a of rho = a + b ln(P / 1 MPa), moist green bulk density (dry density times 1 + moisture)", .fallback = 1521.0, .placeholder = true});
  r.number("density_per_ln_mpa_kg_m3", c.density_b_kg_m3, {1, 1000, "kg/m3"},
           {.help = "b of rho = a + b ln(P / 1 MPa)", .fallback = 143.5, .placeholder = true});
  r.number("lateral_length_factor", c.lateral_length_factor, {0, 5},
           {.help = "l_p = factor * pressed thickness in u = -l_p^2 grad(dm/m)", .fallback = 0.5, .placeholder = true});
  r.number("springback_percent", c.springback, {0, 3, "%"},
           {.help = "linear expansion in the plane when the pressure is released", .fallback = 0.5, .placeholder = true});
  r.number("edge_gain_mm", c.edge_gain_m, {-20, 20, "mm"},
           {.help = "outward displacement of each long edge under pressure", .fallback = 0.8, .placeholder = true});
  r.number("edge_zone_mm", c.edge_zone_m, {1, 300, "mm"},
           {.help = "distance from the edge over which the edge displacement fades", .fallback = 30.0, .placeholder = true});
  r.object(
      "dem", "cohesive DEM slice between floor and lid",
      [&](ObjectReader& d) {
        read_slice_numerics(d, c.numerics, 4, 8, 1.5);
        d.number("stiffness_ratio_k2_k1", c.stiffness_ratio, {1, 100},
                 {.help = "EEPA unloading over loading stiffness", .fallback = 5.0, .placeholder = true});
        d.number("adhesion_ratio_kadh_k1", c.adhesion_ratio, {0, 10},
                 {.help = "EEPA adhesion over loading stiffness", .fallback = 0.2, .placeholder = true});
        d.number("bed_height_mm", c.bed_height_m, {3, 100, "mm"}, {.help = "loose bed in the slice before pressing", .fallback = 14.0});
        d.number("lid_speed_m_s", c.lid_speed_m_s, {0.001, 2, "m/s"},
                 {.help = "speed of the lid: slow enough that the bed follows (reported as inertial number)", .fallback = 0.15});
        d.number("end_solid_fraction", c.end_solid_fraction, {0.5, 0.9, "1", "granules impinge beyond"},
                 {.help = "solid fraction at which DEM pressing ends; the map is affine beyond", .fallback = 0.80});
        d.number("settle_s", c.settle_s, {0.01, 10, "s"}, {.help = "time for the poured bed to come to rest", .fallback = 0.12});
      },
      false);
}
}  // namespace venato::line::press
