#pragma once
#include "sync/registration/ecc_refine.h"
#include "sync/registration/nonrigid.h"
namespace venato::sync {

/// Fills gates, success, reason, confidence, zones, sigma_m and internal_residual_m of `out` from the finished fit (registration_print.md 1.5).
void judge(const Features& green, const PoseSearch& search, const RefinedPose& pose, const NonrigidResult& fit, const Feature& print_signed,
           const RegistrationConfig& config, const BSplineField& prior_field, int threads, Registration& out);
/// success = false with this gate as the only reason.
void fail(Registration& out, Gate gate, std::string reason);
}  // namespace venato::sync
