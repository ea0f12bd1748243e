#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "line/products/bed.h"
namespace venato::line {

/// Mass-stochastic stage kernel K(theta, eta; zeta' -> zeta) (multiscale.md 2.1): where the powder of an input layer ends up.
/// theta [s] is the delay minus `reference_delay_s` (the mass-mean delay over everything, kept apart so that the grid stays small); a positive theta
/// lies upstream on the belt: y_out = y_in - v * (reference_delay + theta) + v * nominal_delay, see apply(). eta [m] is the shift across the belt,
/// made symmetric (the slices are). Samples sit at cell centres theta0 + (i + 1/2) dtheta, eta0 + (j + 1/2) deta; each weight is the mass in that
/// cell. Sum over (zeta, theta, eta) is 1 for every zeta'. Where full_bed: sum over (zeta', theta, eta) is 1 for every zeta (equal layers stay
/// equal).
struct Operator {
  std::string stage;
  int nz_in = 1, nz_out = 1, n_theta = 1, n_eta = 1;
  double theta0_s = 0, dtheta_s = 0, eta0_m = 0, deta_m = 0;
  double reference_delay_s = 0;
  bool full_bed = false;
  std::vector<double> weight;                       ///< [zin][zout][theta][eta]
  std::vector<std::vector<double>> replicates;      ///< bootstrap: same layout each
  std::vector<double> replicate_reference_delay_s;  ///< one per replicate
  /// Figures that justify it and KPIs, all SI, key ends in unit: "stationarity_velocity_change", "superposition_defect", "sinkhorn_correction",
  /// "mass_flow_kg_s", "latency_on_s", "diffusivity_zz_m2_s", "particles", "coarse_graining" …
  std::map<std::string, double> figures;
  /// Curves for the report: name -> (columns with names). E.g. "step_response": {"time_s": …, "mass_flow_kg_s": …}.
  std::map<std::string, std::map<std::string, std::vector<double>>> curves;
  std::vector<std::string> warnings;
  std::string provenance_json;  ///< canonical inputs, seed, versions

  std::size_t index(int zin, int zout, int it, int ie) const {
    return ((static_cast<std::size_t>(zin) * static_cast<std::size_t>(nz_out) + static_cast<std::size_t>(zout)) * static_cast<std::size_t>(n_theta) +
            static_cast<std::size_t>(it)) *
               static_cast<std::size_t>(n_eta) +
           static_cast<std::size_t>(ie);
  }
};

Operator identity_operator(int nz);

/// Weighted tracer landings (or projected tracers) -> kernel on a grid just wide enough for all of them; eta symmetrised; Sinkhorn-scaled when
/// full_bed (largest correction in figures["sinkhorn_correction"]).
struct Landing {
  int zeta_in;
  int zeta_out;
  double theta_s, eta_m, weight;
};
Operator operator_from_landings(const std::string& stage, const std::vector<Landing>& landings, int nz_in, int nz_out, double dtheta_s, double deta_m,
                                bool full_bed);

/// Bed after the stage: mass_out[k][zout] = sum_zin K * mass_in[k][zin], convolved in y (periodic) and x (mirror walls). The kernel is resampled onto
/// the bed grid with exact mass and mean. Mass of every powder kept to rounding. op.nz_in must be bed.grid.nz, or 1 (applied to each layer alike,
/// then layers kept). \param belt_speed_m_s > 0;  \param nominal_delay_s what the line's controller already takes off (the encoder shift).
Bed apply(const Operator& op, const Bed& bed, double belt_speed_m_s, double nominal_delay_s, int threads, int replicate = -1);
/// Transposed operator (exact adjoint of apply in the plain inner product of the mass arrays): for inverse design.
Bed apply_transposed(const Operator& op, const Bed& bed, double belt_speed_m_s, double nominal_delay_s, int threads);
/// K2 after K1 on a common grid (equal dtheta, deta required).
Operator compose(const Operator& second, const Operator& first);

void write_operator(const std::filesystem::path& file, const Operator& op);  ///< HDF5 "venato-operator" version 1
Operator read_operator(const std::filesystem::path& file);
}  // namespace venato::line
