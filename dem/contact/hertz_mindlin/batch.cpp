#include "dem/contact/hertz_mindlin/batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/hertz_mindlin/batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace venato::dem::HWY_NAMESPACE {
namespace {  // several laws have these names
void evaluate_batch(PairBatch& b, int lanes, double dt) { evaluate_lanes<HertzMindlin>(b, lanes, dt); }
ContactForce force_of(const HertzMindlin& law, const ContactGeometry& g, ContactHistory& h, double dt) { return law.force(g, h, dt); }
}  // namespace
}  // namespace venato::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace venato::dem {
HWY_EXPORT(evaluate_batch);
HWY_EXPORT(force_of);
void evaluate_batch(const HertzMindlin*, PairBatch& b, int lanes, double dt) { HWY_DYNAMIC_DISPATCH(evaluate_batch)(b, lanes, dt); }
ContactForce force_of(const HertzMindlin& law, const ContactGeometry& g, ContactHistory& h, double dt) {
  return HWY_DYNAMIC_DISPATCH(force_of)(law, g, h, dt);
}
}  // namespace venato::dem
#endif
