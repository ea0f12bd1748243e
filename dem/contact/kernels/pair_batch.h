#pragma once
/// Grain-grain contacts are worked on in small batches, one array per quantity, so that the compiler turns the law into vector code of the machine
/// (target_clones in <law>/batch.cpp). Every lane does the same scalar operations in the same order on every machine: same bytes.
#include <cmath>
#include <cstddef>
#include <utility>

#include "dem/contact/kernels/contact_types.h"

namespace venato::dem {

inline constexpr int kBatchWidth = 16;
inline constexpr int kMaxParameters = 9;

/// Raw state of touching pairs; `from_i` = position of j seen from i (periodic image already chosen).
struct alignas(64) PairBatch {
  using Lane = double[kBatchWidth];
  Lane from_i_x, from_i_y, from_i_z;        ///< [m]
  Lane dv_x, dv_y, dv_z;                    ///< [m/s] v_j - v_i, half step
  Lane wi_x, wi_y, wi_z, wj_x, wj_y, wj_z;  ///< [rad/s]
  Lane radius_i, radius_j, inverse_mass_i, inverse_mass_j;
  double parameter[kMaxParameters][kBatchWidth];
  double history[7][kBatchWidth];                                               ///< ContactHistory, member by member; in and out
  Lane force_x, force_y, force_z;                                               ///< out: on i [N]
  Lane torque_i_x, torque_i_y, torque_i_z, torque_j_x, torque_j_y, torque_j_z;  ///< out [N m]
  Lane overlap;                                                                 ///< out [m]
};

struct PairFrame {
  ContactGeometry g;
  double arm_i, arm_j;  ///< [m] R - overlap/2: both torques act at one point, so angular momentum is exact
};

/// 1/a, 1/b, 1/c from 1/(abc): the divider is what bounds the contact loop, so everything shares one division.
struct Inverses {
  double a, b, c;
};
VENATO_KERNEL Inverses inverses(double a, double b, double c, double one_over_product) {
  return {one_over_product * (b * c), one_over_product * (a * c), one_over_product * (a * b)};
}

VENATO_KERNEL PairFrame pair_frame(const PairBatch& b, int l, double dt) {
  const Trio to_j{b.from_i_x[l], b.from_i_y[l], b.from_i_z[l]}, dv{b.dv_x[l], b.dv_y[l], b.dv_z[l]};
  const Trio wi{b.wi_x[l], b.wi_y[l], b.wi_z[l]}, wj{b.wj_x[l], b.wj_y[l], b.wj_z[l]};
  const double ri = b.radius_i[l], rj = b.radius_j[l];
  // Positions of the last step and (twice) of the half step follow exactly from the half-step velocity: neither an old normal nor an old overlap
  // needs storing.
  const Trio before = fused::add(-dt, dv, to_j), chord = before + to_j;
  const double d2 = fused::dot(to_j, to_j), before2 = fused::dot(before, before), along = fused::dot(before, to_j);
  const double distance = std::sqrt(d2), earlier = std::sqrt(before2), chord2 = fused::add(2, along, before2 + d2);
  const double twirl = (0.25 * dt) * fused::dot(wi + wj, to_j);  // spin about the normal: tan(half the angle) = twirl / distance
  const double bent = fused::add(distance, earlier, along), twirl2 = twirl * twirl, spun = d2 + twirl2, turn = bent * spun;
  const double im_i = b.inverse_mass_i[l], im_j = b.inverse_mass_j[l], ri2 = ri * ri, rj2 = rj * rj;
  const double radii = ri + rj, inverse_masses = im_i + im_j, inverse_inertias = im_i * rj2 + im_j * ri2;
  const double places = distance * chord2 * turn, sizes = radii * inverse_masses * inverse_inertias, q = 1 / (places * sizes);
  const Inverses over = inverses(distance, chord2, turn, q * sizes), eff = inverses(radii, inverse_masses, inverse_inertias, q * places);
  const Trio n = over.a * to_j;
  const double gap = radii - distance, gap_before = radii - earlier;
  const double overlap = gap > 0 ? gap : 0.0;  // the touch test compares squares: rounding may leave -1e-20 here
  PairFrame f;
  f.arm_i = fused::add(-0.5, overlap, ri);
  f.arm_j = fused::add(-0.5, overlap, rj);
  f.g.overlap = overlap, f.g.overlap_before = gap_before > 0 ? gap_before : 0.0;
  f.g.approach = -fused::dot(dv, n);
  const Trio across_half = fused::add(-(fused::dot(dv, chord) * over.b), chord, dv);            // across the half-step normal
  f.g.slide = fused::cross(f.arm_i * wi + f.arm_j * wj, (0.5 * over.a) * chord) - across_half;  // a chord: exact for rigid turns
  f.g.roll = fused::across(wi - wj, n);
  f.g.normal = n;
  const double over_bent = over.c * spun, over_spun = over.c * bent;
  f.g.turn.way = over_bent * fused::add(distance, before, earlier * to_j);
  f.g.turn.cosine = (d2 - twirl2) * over_spun, f.g.turn.sine = 2 * (twirl * distance) * over_spun;
  f.g.r_eff = ri * rj * eff.a;
  f.g.m_eff = eff.b;
  f.g.i_roll = 1.4 * (ri2 * rj2) * eff.c;
  return f;
}

VENATO_KERNEL ContactHistory history_of(const PairBatch& b, int l) {
  return {{b.history[0][l], b.history[1][l], b.history[2][l]}, {b.history[3][l], b.history[4][l], b.history[5][l]}, b.history[6][l]};
}

template <ContactLaw L>
VENATO_KERNEL L law_of_lane(const PairBatch& b, int l) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) __attribute__((always_inline)) { return L{b.parameter[k][l]...}; }
  (std::make_index_sequence<L::parameter_count>());
}

/// The first `lanes` lanes of a batch (unused ones among them hold harmless numbers). Always inlined into a function for one kind of CPU.
template <ContactLaw L>
VENATO_KERNEL void evaluate_lanes(PairBatch& b, int lanes, double dt) {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const PairFrame f = pair_frame(b, l, dt);
    ContactHistory h = history_of(b, l);
    const L law = law_of_lane<L>(b, l);
    const ContactForce c = law.force(f.g, h, dt);
    const Trio force = fused::add(-c.normal, f.g.normal, c.tangential), lever = fused::cross(f.g.normal, c.tangential);
    const Trio on_i = fused::add(f.arm_i, lever, c.rolling), on_j = fused::add(f.arm_j, lever, -c.rolling);
    b.overlap[l] = f.g.overlap;
    b.force_x[l] = force.x, b.force_y[l] = force.y, b.force_z[l] = force.z;
    b.torque_i_x[l] = on_i.x, b.torque_i_y[l] = on_i.y, b.torque_i_z[l] = on_i.z;
    b.torque_j_x[l] = on_j.x, b.torque_j_y[l] = on_j.y, b.torque_j_z[l] = on_j.z;
    b.history[0][l] = h.spring.x, b.history[1][l] = h.spring.y, b.history[2][l] = h.spring.z;
    b.history[3][l] = h.rolling.x, b.history[4][l] = h.rolling.y, b.history[5][l] = h.rolling.z, b.history[6][l] = h.plastic;
  }
}
}  // namespace venato::dem
