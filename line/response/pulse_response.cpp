#include "line/response/pulse_response.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/expects.h"
#include "base/rng.h"

namespace venato::line {
namespace {

/// Overlap of the bin [a, b) with all "on" windows shifted by the delay bin; averaged over the delay bin by its centre (bins are short).
double on_time(const std::vector<PulseWindow>& pulses, double a, double b) {
  double t = 0;
  for (const PulseWindow& p : pulses) t += std::max(0.0, std::min(b, p.off_s) - std::max(a, p.on_s));
  return t;
}

void smooth(std::vector<double>& g, double sigma) {
  if (sigma <= 0) return;
  const int half = static_cast<int>(std::ceil(3 * sigma));
  std::vector<double> out(g.size(), 0.0);
  const int n = static_cast<int>(g.size());
  for (int i = 0; i < n; ++i) {
    double norm = 0;
    for (int k = -half; k <= half; ++k) norm += std::exp(-0.5 * k * k / (sigma * sigma));
    for (int k = -half; k <= half; ++k) {
      const int j = std::clamp(i + k, 0, n - 1);  // mass that would leave the range stays at its end: the sum is kept
      out[static_cast<std::size_t>(j)] += g[static_cast<std::size_t>(i)] * std::exp(-0.5 * k * k / (sigma * sigma)) / norm;
    }
  }
  g = std::move(out);
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

std::vector<PulseWindow> random_pulse_train(int pulses, double start_s, double min_on_s, double max_on_s, double min_off_s, double max_off_s, std::uint64_t seed) {
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
  const auto m = static_cast<std::size_t>(std::ceil(options.max_delay_s / dt));
  std::vector<double> f(n, 0.0);
  double total = 0;
  for (const TimedMass& g : landed) {
    const double pos = (g.time_s - start_s) / dt;
    if (pos < 0 || pos >= static_cast<double>(n)) continue;
    f[static_cast<std::size_t>(pos)] += g.mass_kg / dt;
    total += g.mass_kg;
  }
  if (!(total > 0)) throw WorkError("no powder was discharged while the device was on: check the drive, the opening and the fill level");

  // Command seen by data bin i at delay bin j depends on i - j only: one table.
  std::vector<double> on(n + m);
  for (std::size_t k = 0; k < n + m; ++k) {
    const double a = start_s + (static_cast<double>(k) - static_cast<double>(m)) * dt;
    on[k] = on_time(pulses, a, a + dt) / dt;
  }
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
  auto model = [&](const std::vector<double>& g) {
    std::vector<double> y(n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < m; ++j) y[i] += on[m + i - j] * g[j];
    return y;
  };
  std::vector<double> norm(m, 0.0);
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i < n; ++i) norm[j] += w[i] * on[m + i - j];
  std::vector<double> g(m, total / (end_s - start_s) / static_cast<double>(m));
  for (int it = 0; it < options.iterations; ++it) {
    const std::vector<double> y = model(g);
    std::vector<double> next(m, 0.0);
    for (std::size_t j = 0; j < m; ++j) {
      if (norm[j] <= 0) continue;
      double s = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (y[i] > 0) s += w[i] * on[m + i - j] * f[i] / y[i];
      next[j] = g[j] * s / norm[j];
    }
    smooth(next, options.smoothing_bins);
    g = std::move(next);
  }
  PulseResponse r;
  double sum = 0, first = 0, second = 0;
  for (std::size_t j = 0; j < m; ++j) sum += g[j];
  for (std::size_t j = 0; j < m; ++j) {
    // on[] of data bin i and delay index j covers [t_i - j dt): the mean delay of index j is j * dt.
    const double d = static_cast<double>(j) * dt;
    r.delay_s.push_back(d);
    r.weight.push_back(g[j] / sum);
    first += d * g[j] / sum;
    second += d * d * g[j] / sum;
  }
  r.mass_flow_kg_s = sum;
  r.mean_delay_s = first;
  r.sd_delay_s = std::sqrt(std::max(0.0, second - first * first));

  // Aligned mean flow after each switch, measured and modelled.
  const std::vector<double> y = model(g);
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
    if (n_on[i] > 1) defect += std::abs(r.flow_after_on_kg_s[i] - r.model_after_on_kg_s[i]), size += r.model_after_on_kg_s[i];
    if (n_off[i] > 1) defect += std::abs(r.flow_after_off_kg_s[i] - model_off[i]), size += model_off[i];
  }
  r.superposition_defect = size > 0 ? defect / size : std::nan("");
  r.latency_on_s = crossing(r.edge_time_s, r.flow_after_on_kg_s, 0.5 * sum, true);
  r.latency_off_s = crossing(r.edge_time_s, r.flow_after_off_kg_s, 0.5 * sum, false);
  r.rise_s = crossing(r.edge_time_s, r.flow_after_on_kg_s, 0.9 * sum, true) - crossing(r.edge_time_s, r.flow_after_on_kg_s, 0.1 * sum, true);
  r.decay_s = crossing(r.edge_time_s, r.flow_after_off_kg_s, 0.1 * sum, false) - crossing(r.edge_time_s, r.flow_after_off_kg_s, 0.9 * sum, false);

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
