#include "line/response/pulse_response.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/rng.h"

namespace venato::line {
namespace {

constexpr double kFlow = 4e-3, kGrain = 1e-6;  // 4 g/s in grains of 1 mg: 4000 grains per second of opening

/// Grains released uniformly while on, each delayed by `delay(rng, k)`.
template <class Delay>
std::vector<TimedMass> discharge(const std::vector<PulseWindow>& train, Delay&& delay) {
  Rng rng(5, 1234);
  std::vector<TimedMass> landed;
  for (std::size_t k = 0; k < train.size(); ++k) {
    const double length = train[k].off_s - train[k].on_s;
    const auto n = static_cast<int>(length * kFlow / kGrain);
    for (int i = 0; i < n; ++i) {
      const double since = rng.uniform() * length;
      landed.push_back({train[k].on_s + since + delay(rng, since, length), kGrain});
    }
  }
  return landed;
}
std::vector<PulseWindow> train() { return random_pulse_train(24, 0.2, 0.04, 0.12, 0.04, 0.12, 7); }
PulseResponse estimate(const std::vector<TimedMass>& landed, const std::vector<PulseWindow>& t, const std::vector<double>& weights = {}) {
  return estimate_pulse_response(landed, t, 0.2, t.back().off_s + 0.4, {}, weights);
}
double triangular(Rng& rng) { return 0.10 + 0.02 * (rng.uniform() + rng.uniform()); }  // mean 0.12, sd 0.02 / sqrt(6)

TEST(PulseResponse, RecoversDelayFlowAndSpreadOfALinearDevice) {
  const auto t = train();
  const PulseResponse r = estimate(discharge(t, [](Rng& g, double, double) { return triangular(g); }), t);
  // ~7700 grains: the mean delay has a standard error of 0.0082 / sqrt(7700) = 0.1 ms plus half a bin of 2.5 ms from the binning.
  EXPECT_NEAR(r.mean_delay_s, 0.12, 0.0013);
  EXPECT_NEAR(r.mass_flow_kg_s, kFlow, 0.01 * kFlow);
  // The binned data are modelled exactly; what is left is the scatter of 7700 grains (0.1 ms) and the shape: a triangle is not a gamma law.
  EXPECT_NEAR(r.sd_delay_s, 0.0082, 0.0010);
  double sum = 0;
  for (const double w : r.weight) {
    EXPECT_GE(w, 0.0);
    sum += w;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(r.latency_on_s, 0.12, 0.004);  // symmetric delay law: half the flow at the mean; two bins
  EXPECT_NEAR(r.latency_off_s, 0.12, 0.004);
  EXPECT_LT(r.superposition_defect, 0.12);  // shot noise of 4000 grains/s over ~24 edges in 2.5 ms bins: sqrt(1/240) = 6 %
  EXPECT_GT(r.superposition_defect, 0.0);
}

TEST(PulseResponse, TellsADeviceThatIsNotLinear) {
  // Slow start: grains of the first 30 ms of every pulse are 40 ms late. No fixed delay law can describe that.
  const auto t = train();
  const PulseResponse linear = estimate(discharge(t, [](Rng& g, double, double) { return triangular(g); }), t);
  const PulseResponse sticky = estimate(discharge(t, [](Rng& g, double since, double) { return triangular(g) + (since < 0.03 ? 0.04 : 0.0); }), t);
  EXPECT_GT(sticky.superposition_defect, 1.5 * linear.superposition_defect);
}

TEST(PulseResponse, BootstrapWeightsChangeTheAnswerAndEqualWeightsDoNot) {
  const auto t = train();
  const auto landed = discharge(t, [](Rng& g, double, double) { return triangular(g); });
  const PulseResponse plain = estimate(landed, t), ones = estimate(landed, t, std::vector<double>(t.size(), 1.0));
  EXPECT_EQ(plain.weight, ones.weight);
  std::vector<double> some(t.size(), 0.0);
  for (std::size_t k = 0; k < t.size(); k += 2) some[k] = 2;
  const PulseResponse half = estimate(landed, t, some);
  EXPECT_NE(plain.weight, half.weight);
  EXPECT_NEAR(half.mean_delay_s, plain.mean_delay_s, 0.002);  // same device: within a few standard errors of half the data
}

TEST(PulseResponse, NothingDischargedIsAnError) { EXPECT_THROW(estimate({}, train()), WorkError); }

TEST(PulseTrain, IsDeterministicAndOrdered) {
  const auto a = train(), b = train();
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].on_s, b[k].on_s);
    EXPECT_GE(a[k].off_s - a[k].on_s, 0.04);
    EXPECT_LE(a[k].off_s - a[k].on_s, 0.12);
    if (k > 0) {
      EXPECT_GE(a[k].on_s - a[k - 1].off_s, 0.04);
    }
  }
}
}  // namespace
}  // namespace venato::line
