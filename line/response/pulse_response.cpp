#include "line/response/pulse_response.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <unsupported/Eigen/SpecialFunctions>

#include "base/error.h"
#include "base/expects.h"
#include "base/rng.h"

namespace venato::line {
namespace {

/// Delay law: gamma distribution with a dead time, given by mean, standard deviation and shape (1 = exponential, large = normal).
struct DelayLaw {
  double mean_s, sd_s, shape;
};

double cumulated(const DelayLaw& law, double t_s) {
  const double dead = law.mean_s - std::sqrt(law.shape) * law.sd_s, scale = law.sd_s / std::sqrt(law.shape);
  return t_s <= dead ? 0.0 : Eigen::numext::igamma(law.shape, (t_s - dead) / scale);
}

/// Integral of cumulated() on a fine table: what is needed per bin is the integral over the bin, exactly.
class DelayTable {
 public:
  explicit DelayTable(const DelayLaw& law) : low_(law.mean_s - 6 * law.sd_s), step_(law.sd_s / 20), integral_(1, 0.0) {
    const double span = 16 * law.sd_s;  // -6 … +10 sd: beyond lies less than 1e-4 of an exponential tail
    double before = cumulated(law, low_);
    for (double t = step_; t <= span; t += step_) {
      const double here = cumulated(law, low_ + t);
      integral_.push_back(integral_.back() + 0.5 * (before + here) * step_);
      before = here;
    }
  }
  double integral(double t_s) const {  // of the cumulated law from -inf to t
    const double at = (t_s - low_) / step_;
    if (at <= 0) return 0;
    const auto last = static_cast<double>(integral_.size() - 1);
    if (at >= last) return integral_.back() + (at - last) * step_;
    const auto k = static_cast<std::size_t>(at);
    return integral_[k] + (at - static_cast<double>(k)) * (integral_[k + 1] - integral_[k]);
  }

 private:
  double low_, step_;
  std::vector<double> integral_;
};

/// Mean of (box * G) over the bin [a, b) for unit flow while on.
double modelled(const DelayTable& table, const std::vector<PulseWindow>& pulses, double a, double b) {
  double sum = 0;
  for (const PulseWindow& p : pulses)
    sum += (table.integral(b - p.on_s) - table.integral(a - p.on_s)) - (table.integral(b - p.off_s) - table.integral(a - p.off_s));
  return sum / (b - a);
}

/// Least squares of the binned flow in (flow, mean, ln sd, ln shape): residuals for Eigen's Levenberg-Marquardt.
struct FlowFit {
  using Scalar = double;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  const std::vector<PulseWindow>& pulses;
  const std::vector<double>&flow, &weight;
  double start_s, bin_s, unit;
  int inputs() const { return 4; }
  int values() const { return static_cast<int>(flow.size()); }
  static DelayLaw law(const InputType& p) { return {p[1], std::exp(std::clamp(p[2], -9.0, 2.0)), std::exp(std::clamp(p[3], 0.0, 5.0))}; }
  int operator()(const InputType& p, ValueType& r) const {
    const DelayTable table(law(p));
    for (std::size_t i = 0; i < flow.size(); ++i) {
      const double a = start_s + static_cast<double>(i) * bin_s;
      r[static_cast<Eigen::Index>(i)] = std::sqrt(weight[i]) * (flow[i] / unit - p[0] * modelled(table, pulses, a, a + bin_s));
    }
    return 0;
  }
};

/// Mean over 2 half + 1 samples, missing ones left out.
std::vector<double> moving_average(const std::vector<double>& f, std::size_t half) {
  std::vector<double> out(f.size(), std::nan(""));
  for (std::size_t i = 0; i < f.size(); ++i) {
    double total = 0, n = 0;
    for (std::size_t k = i > half ? i - half : 0; k < std::min(f.size(), i + half + 1); ++k)
      if (!std::isnan(f[k])) total += f[k], n += 1;
    if (n > 0) out[i] = total / n;
  }
  return out;
}

/// Delay below which the share `u` of the powder arrives.
double quantile(const PulseResponse& r, double u) {
  double sum = 0;
  for (std::size_t j = 0; j < r.weight.size(); ++j)
    if ((sum += r.weight[j]) >= u) return r.delay_s[j];
  return r.delay_s.back();
}

/// First time the curve crosses `level`, linear between samples (missing ones are stepped over); NaN when it never does.
double crossing(const std::vector<double>& t, const std::vector<double>& f, double level, bool rising) {
  std::size_t last = f.size();
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (std::isnan(f[i])) continue;
    if (last < i) {
      const bool hit = rising ? (f[last] < level && f[i] >= level) : (f[last] > level && f[i] <= level);
      if (hit) return t[last] + (level - f[last]) / (f[i] - f[last]) * (t[i] - t[last]);
    }
    last = i;
  }
  return std::nan("");
}
}  // namespace

std::vector<PulseWindow> random_pulse_train(int pulses, double start_s, double min_on_s, double max_on_s, double min_off_s, double max_off_s,
                                            std::uint64_t seed) {
  VENATO_EXPECTS(pulses > 0 && max_on_s >= min_on_s && max_off_s >= min_off_s);
  Rng rng(seed, stream_id("line/pulse_train"));
  std::vector<PulseWindow> train;
  double t = start_s;
  for (int k = 0; k < pulses; ++k) {
    const double on = min_on_s + (max_on_s - min_on_s) * rng.uniform();
    const double off = min_off_s + (max_off_s - min_off_s) * rng.uniform();
    train.push_back({t, t + on});
    t += on + off;
  }
  return train;
}

PulseResponse estimate_pulse_response(const std::vector<TimedMass>& landed, const std::vector<PulseWindow>& pulses, double start_s, double end_s,
                                      const ResponseOptions& options, const std::vector<double>& block_weights) {
  VENATO_EXPECTS(!pulses.empty() && end_s > start_s && options.bin_s > 0);
  const double dt = options.bin_s;
  const auto n = static_cast<std::size_t>(std::floor((end_s - start_s) / dt));
  std::vector<double> f(n, 0.0);
  double total = 0, moment = 0, on_total = 0, on_moment = 0;
  for (const TimedMass& g : landed) {
    const double pos = (g.time_s - start_s) / dt;
    if (pos < 0 || pos >= static_cast<double>(n)) continue;
    f[static_cast<std::size_t>(pos)] += g.mass_kg / dt;
    total += g.mass_kg;
    moment += g.mass_kg * g.time_s;
  }
  if (!(total > 0)) throw WorkError("no powder was discharged while the device was on: check the drive, the opening and the fill level");
  for (const PulseWindow& p : pulses) on_total += p.off_s - p.on_s, on_moment += 0.5 * (p.off_s * p.off_s - p.on_s * p.on_s);

  // A data bin belongs to the pulse that began last: bootstrap weights follow the pulses.
  std::vector<double> w(n, 1.0);
  if (!block_weights.empty()) {
    VENATO_EXPECTS(block_weights.size() == pulses.size());
    for (std::size_t i = 0; i < n; ++i) {
      const double t = start_s + (static_cast<double>(i) + 0.5) * dt;
      std::size_t k = 0;
      while (k + 1 < pulses.size() && pulses[k + 1].on_s <= t) ++k;
      w[i] = block_weights[k];
    }
  }
  // For a linear device the mean landing time is the mean command time plus the mean delay: a start close to the answer.
  const double unit = total / on_total;
  Eigen::VectorXd best;
  double best_norm = HUGE_VAL;
  for (const double sd : {0.008, 0.025, 0.07}) {  // the sum of squares has local minima in the spread: start narrow, medium and wide
    Eigen::VectorXd p(4);
    p << 1.0, moment / total - on_moment / on_total, std::log(sd), std::log(4.0);
    Eigen::NumericalDiff<FlowFit> fit(FlowFit{pulses, f, w, start_s, dt, unit}, 1e-6);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<FlowFit>> solver(fit);
    solver.parameters.maxfev = 400;
    solver.minimize(p);
    if (std::isfinite(solver.fnorm) && solver.fnorm < best_norm) best_norm = solver.fnorm, best = p;
  }
  if (best.size() == 0) throw WorkError("the response of the device to its commands could not be fitted: the flow does not follow the commands");
  const DelayLaw law = FlowFit::law(best);
  if (!(best[0] > 0) || !(law.mean_s > -0.5) || !(law.mean_s < end_s - start_s))
    throw WorkError("the response of the device to its commands could not be fitted: flow " + std::to_string(best[0] * unit * 1e3) +
                    " g/s at a mean delay of " + std::to_string(law.mean_s) + " s; give more or longer pulses");
  PulseResponse r;
  r.mass_flow_kg_s = best[0] * unit;
  const double sum = r.mass_flow_kg_s;
  const DelayTable table(law);
  double norm = 0, first = 0, second = 0,
         before = cumulated(law, std::floor((law.mean_s - 6 * law.sd_s) / options.kernel_bin_s) * options.kernel_bin_s);
  for (double k = std::floor((law.mean_s - 6 * law.sd_s) / options.kernel_bin_s); k * options.kernel_bin_s < law.mean_s + 10 * law.sd_s; ++k) {
    const double here = cumulated(law, (k + 1) * options.kernel_bin_s);
    if (here > before) r.delay_s.push_back((k + 0.5) * options.kernel_bin_s), r.weight.push_back(here - before), norm += here - before;
    before = here;
  }
  for (std::size_t j = 0; j < r.weight.size(); ++j) {
    r.weight[j] /= norm;
    first += r.weight[j] * r.delay_s[j];
    second += r.weight[j] * r.delay_s[j] * r.delay_s[j];
  }
  r.mean_delay_s = first;
  r.sd_delay_s = std::sqrt(std::max(0.0, second - first * first));
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double a = start_s + static_cast<double>(i) * dt;
    y[i] = sum * modelled(table, pulses, a, a + dt);
  }

  // Aligned mean flow after each switch, measured and modelled.
  const auto span = static_cast<std::size_t>(std::ceil((r.mean_delay_s + 4 * r.sd_delay_s) / dt)) + 4;
  std::vector<double> n_on(span, 0.0), n_off(span, 0.0), model_off(span, 0.0);
  r.edge_time_s.resize(span);
  r.flow_after_on_kg_s.assign(span, 0.0);
  r.flow_after_off_kg_s.assign(span, 0.0);
  r.model_after_on_kg_s.assign(span, 0.0);
  for (std::size_t k = 0; k < pulses.size(); ++k) {
    const double on_until = pulses[k].off_s + r.mean_delay_s;
    const double off_until = (k + 1 < pulses.size() ? pulses[k + 1].on_s : end_s) + r.mean_delay_s;
    // Delays may be longer than pulses: what lands soon after a switch can still belong to the pulse before, and is left out.
    const double margin = r.mean_delay_s + 2 * r.sd_delay_s;
    const double on_from = k ? pulses[k - 1].off_s + margin : start_s, off_from = pulses[k].on_s + margin;
    for (std::size_t i = 0; i < span; ++i) {
      const double t_on = pulses[k].on_s + (static_cast<double>(i) + 0.5) * dt, t_off = pulses[k].off_s + (static_cast<double>(i) + 0.5) * dt;
      const double a = (t_on - start_s) / dt, b = (t_off - start_s) / dt;
      if (t_on >= on_from && t_on < on_until && a >= 0 && a < static_cast<double>(n)) {
        r.flow_after_on_kg_s[i] += f[static_cast<std::size_t>(a)];
        r.model_after_on_kg_s[i] += y[static_cast<std::size_t>(a)];
        n_on[i] += 1;
      }
      if (t_off >= off_from && t_off < off_until && b >= 0 && b < static_cast<double>(n)) {
        r.flow_after_off_kg_s[i] += f[static_cast<std::size_t>(b)];
        model_off[i] += y[static_cast<std::size_t>(b)];
        n_off[i] += 1;
      }
    }
  }
  double defect = 0, size = 0;
  for (std::size_t i = 0; i < span; ++i) {
    r.edge_time_s[i] = (static_cast<double>(i) + 0.5) * dt;
    auto mean = [](double& v, double count) { v = count > 0 ? v / count : std::nan(""); };
    mean(r.flow_after_on_kg_s[i], n_on[i]);
    mean(r.model_after_on_kg_s[i], n_on[i]);
    mean(r.flow_after_off_kg_s[i], n_off[i]);
    mean(model_off[i], n_off[i]);
  }
  // Compared over 20 ms, not bin by bin: what single grains scatter is no property of the device.
  const auto group = static_cast<std::size_t>(std::max(1.0, std::round(0.02 / dt)));
  for (std::size_t i = 0; i + group <= span; i += group) {
    double on_gap = 0, on_size = 0, off_gap = 0, off_size = 0;
    for (std::size_t k = i; k < i + group; ++k) {
      if (n_on[k] > 1) on_gap += r.flow_after_on_kg_s[k] - r.model_after_on_kg_s[k], on_size += r.model_after_on_kg_s[k];
      if (n_off[k] > 1) off_gap += r.flow_after_off_kg_s[k] - model_off[k], off_size += model_off[k];
    }
    defect += std::abs(on_gap) + std::abs(off_gap), size += on_size + off_size;
  }
  r.superposition_defect = size > 0 ? defect / size : std::nan("");
  const std::vector<double> on = moving_average(r.flow_after_on_kg_s, group / 2), off = moving_average(r.flow_after_off_kg_s, group / 2);
  r.latency_on_s = crossing(r.edge_time_s, on, 0.5 * sum, true);
  r.latency_off_s = crossing(r.edge_time_s, off, 0.5 * sum, false);
  r.rise_s = quantile(r, 0.9) - quantile(r, 0.1);

  // Time invariance: mass of each pulse against the model, from the middle of one gap to the middle of the next (delayed by the mean).
  double s1 = 0, s2 = 0;
  int count = 0;
  for (std::size_t k = 0; k + 1 < pulses.size(); ++k) {
    const double from = (k ? 0.5 * (pulses[k - 1].off_s + pulses[k].on_s) : pulses[k].on_s) + r.mean_delay_s;
    const double to = 0.5 * (pulses[k].off_s + pulses[k + 1].on_s) + r.mean_delay_s;
    double measured = 0, modelled = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = start_s + (static_cast<double>(i) + 0.5) * dt;
      if (t >= from && t < to) measured += f[i] * dt, modelled += y[i] * dt;
    }
    if (modelled <= 0) continue;
    s1 += measured / modelled;
    s2 += measured / modelled * measured / modelled;
    ++count;
  }
  r.mass_per_pulse_error = count > 1 ? std::sqrt(std::max(0.0, s2 / count - s1 / count * s1 / count)) : std::nan("");
  return r;
}
}  // namespace venato::line
