// Registration of known pairs by Venato, elastix and OpenCV's ECC; tests/bench/registration_vs_peers renders the scenes and calls this.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include "base/store/store.h"
#include "graphics/graphic.h"
#include "sync/overlay/overlay.h"
#include "tests/bench/registration/cases.h"
#include "tests/bench/registration/peers.h"
namespace venato::bench {
namespace {
using sync::Point;
using sync::Registration;
namespace s = sync::synthetic;
constexpr double kFailed_mm = 5;  // median error beyond which a found map is wrong

struct Options {
  int pairs = 20, unrelated = 40, threads = 2, first = 0, worst = 0;
  double prior_error_mm = 0;  ///< 0: without
  std::string out = "out/registration", parameters = VENATO_SOURCE_DIR "/tests/bench/registration/elastix_bspline.txt";
  bool peers = true;
  std::vector<std::string> scenes;
};
/// One related pair, kept to draw the worst of them.
struct Drawn {
  std::size_t index = 0;
  double p95_mm = 0;  ///< infinite where no map was found
  Registration result;
};
struct Row {
  int found = 0, pairs = 0, wrong = 0;
  std::vector<double> median, p95, seconds;
  double mean_of(const std::vector<double>& v) const {
    double sum = 0;
    for (const double x : v) sum += x;
    return v.empty() ? NAN : sum / static_cast<double>(v.size());
  }
};
double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Sorted |error| [mm] on veins that the slab still has. \param faded_only  in the faded strip alone
template <class Map>
std::vector<double> errors_mm(const Pair& pair, const Map& map, bool faded_only = false) {
  std::vector<double> out;
  const auto from = static_cast<int>(pair.faded_from_m * 1e3), to = static_cast<int>(pair.faded_to_m * 1e3);
  for (int j = faded_only ? from + 1 : 1; j < (faded_only ? to : pair.green.height); j += 4)
    for (int i = 1; i < pair.green.width; i += 4) {
      const Point p = Point(i + 0.5, j + 0.5) * 1e-3, q = pair.truth(p);
      if (q.x() < 0 || q.y() < 0 || q.x() > pair.veins.width_m() || q.y() > pair.veins.height_m()) continue;
      if (!pair.kept.empty() && pair.kept.at(i, j) < 0.5f) continue;
      if (s::sample(pair.veins, q) >= 0.5) out.push_back((map(p) - q).norm() * 1e3);
    }
  std::sort(out.begin(), out.end());
  return out;
}
/// |error| of a 2-D Gaussian of root mean square 1 stays below this in 90 %: sqrt(ln 10).
constexpr double kNinety = 1.517427;
/// Zones whose true root mean square error on veins is within the predicted 90 % interval.
/// \param kept_only  veins that the slab has lost do not count
std::pair<int, int> covered_zones(const Pair& pair, const Registration& r, bool kept_only) {
  int covered = 0, judged = 0;
  for (const auto& z : r.zones) {
    double sum = 0;
    int n = 0;
    for (double y = z.y_m + 0.002; y < z.y_m + z.height_m; y += 0.004)
      for (double x = z.x_m + 0.002; x < z.x_m + z.width_m; x += 0.004) {
        const Point q = pair.truth({x, y});
        if (q.x() < 0 || q.y() < 0 || q.x() > pair.veins.width_m() || q.y() > pair.veins.height_m()) continue;
        if (s::sample(pair.veins, q) < 0.5) continue;
        if (kept_only && !pair.kept.empty() && pair.kept.at(static_cast<int>(x * 1e3), static_cast<int>(y * 1e3)) < 0.5f) continue;
        sum += (r.print_from_green({x, y}) - q).squaredNorm();
        ++n;
      }
    if (n < 20) continue;
    ++judged;
    covered += std::sqrt(sum / n) <= kNinety * z.sigma_m ? 1 : 0;
  }
  return {covered, judged};
}

struct Runner {
  Options options;
  std::unique_ptr<Log> log = make_null_log();
  std::unique_ptr<Progress> progress = make_null_progress();
  Store store{"out/registration_store"};
  std::vector<Scene> scenes;
  std::map<std::string, std::map<std::string, Row>> rows;  ///< kind, code
  int covered = 0, zones = 0;                              ///< on veins that the slab still has
  int covered_lost = 0, zones_lost = 0;                    ///< on all veins of the graphic
  double smallest_jacobian = 1;
  std::vector<sync::Phase> phases;  ///< summed over the whole faces
  int whole_faces = 0;
  std::vector<Drawn> drawn;

  void note(const std::string& kind, const char* code, bool found, const std::vector<double>& e, double seconds) {
    Row& r = rows[kind][code];
    const double median = s::at_quantile(e, 0.5), p95 = s::at_quantile(e, 0.95);
    r.pairs += 1;
    if (!found) return;
    r.seconds.push_back(seconds);
    if (!(median <= kFailed_mm)) {
      r.wrong += 1;
      return;
    }
    r.found += 1;
    r.median.push_back(median);
    r.p95.push_back(p95);
  }
  Registration ours(const Pair& pair, double& seconds, const std::optional<sync::Transform>& prior = {}) {
    Context context{*log, *progress, store, 0, options.threads, nullptr};
    const double start = now_s();
    Registration r = sync::register_veins({pair.green, {}, pair.kind}, {pair.print, {}, pair.kind}, {}, prior, context);
    seconds = now_s() - start;
    return r;
  }
  void related() {
    const auto settings = judged_settings(options.first + options.pairs);
    for (std::size_t k = static_cast<std::size_t>(options.first); k < settings.size(); ++k) {
      const Scene& scene = scenes[k % scenes.size()];
      const Pair pair = make_pair(scene, settings[k], 100 + k);
      double seconds = 0;
      const Registration r = ours(pair, seconds);
      const std::vector<double> e = r.success ? errors_mm(pair, r.print_from_green) : std::vector<double>{};
      note(settings[k].kind, "ours", r.success, e, seconds);
      std::printf("pair %zu %s, %s: %s median %.3f P95 %.3f mm, %.2f s", k, scene.name.c_str(), settings[k].kind.c_str(),
                  r.success ? "found" : r.reason.c_str(), s::at_quantile(e, 0.5), s::at_quantile(e, 0.95), seconds);
      for (const sync::Gate& g : r.gates) std::printf(" %s=%.3g", g.name.c_str(), g.value);
      if (!settings[k].portion) {
        ++whole_faces;
        for (const sync::Phase& p : r.phases) {
          const auto at = std::find_if(phases.begin(), phases.end(), [&](const sync::Phase& q) { return q.name == p.name; });
          if (at == phases.end())
            phases.push_back(p);
          else
            at->seconds += p.seconds;
        }
      }
      if (r.success) {
        const auto [good, all] = covered_zones(pair, r, true);
        const auto [good_lost, all_lost] = covered_zones(pair, r, false);
        covered_lost += good_lost;
        zones_lost += all_lost;
        covered += good;
        zones += all;
        const double jacobian = sync::jacobian_range(r.print_from_green.u, pair.green.width_m(), pair.green.height_m(), 0.004).min;
        smallest_jacobian = std::min(smallest_jacobian, jacobian);
        std::printf(", zones %d/%d (with lost veins %d/%d), least Jacobian %.2f", good, all, good_lost, all_lost, jacobian);
      }
      std::printf("\n");
      std::fflush(stdout);
      if (options.prior_error_mm > 0 && settings[k].faded > 0) with_prior(pair, r, 100 + k);
      if (options.worst > 0) keep_for_drawing({k, r.success ? s::at_quantile(e, 0.95) : INFINITY, r});
      if (options.peers) peers(pair, settings[k].kind, r);
    }
  }
  void with_prior(const Pair& pair, const Registration& without, std::uint64_t seed) {
    const sync::Transform prior = make_prior(pair, options.prior_error_mm * 1e-3, seed);
    double seconds = 0;
    const Registration r = ours(pair, seconds, prior);
    const auto print = [&](const char* what, const auto& map) {
      const std::vector<double> e = errors_mm(pair, map, true), all = errors_mm(pair, map);
      std::printf("  %s: faded strip median %.3f P95 %.3f mm, whole slab median %.3f P95 %.3f mm\n", what, s::at_quantile(e, 0.5),
                  s::at_quantile(e, 0.95), s::at_quantile(all, 0.5), s::at_quantile(all, 0.95));
    };
    print("the prior itself", prior);
    if (without.success) print("without prior", without.print_from_green);
    if (r.success)
      print("with prior", r.print_from_green);
    else
      std::printf("  with prior: %s\n", r.reason.c_str());
    std::fflush(stdout);
  }
  void keep_for_drawing(Drawn one) {
    drawn.push_back(std::move(one));
    std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& l, const Drawn& r) { return l.p95_mm > r.p95_mm; });
    if (drawn.size() > static_cast<std::size_t>(options.worst)) drawn.pop_back();
  }
  /// worst_NN_overlay.png: true veins on the slab against the graphic's at the nominal place and where the map found puts them.
  /// worst_NN_error.png: |error| of the map on every vein the slab still has.
  void draw_worst() {
    const auto settings = judged_settings(options.first + options.pairs);
    for (std::size_t n = 0; n < drawn.size(); ++n) {
      const Drawn& one = drawn[n];
      const PairSettings& setting = settings[one.index];
      const Pair pair = make_pair(scenes[one.index % scenes.size()], setting, 100 + one.index);
      const int width = pair.green.width, height = pair.green.height;
      graphics::Raster8 body(width, height, 1, 1e-3), before = body, after = body;
      std::vector<sync::ResidualSample> errors;
      for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
          const Point p = Point(i + 0.5, j + 0.5) * 1e-3, q = pair.truth(p), found = one.result.print_from_green(p);
          const bool kept = pair.kept.empty() || pair.kept.at(i, j) >= 0.5f, vein = s::sample(pair.veins, q) >= 0.5;
          body.at(i, j) = vein && kept ? 255 : 0;
          before.at(i, j) = s::sample(pair.veins, p) >= 0.5 ? 255 : 0;
          after.at(i, j) = s::sample(pair.veins, found) >= 0.5 ? 255 : 0;
          if (vein && kept && i % 4 == 0 && j % 4 == 0) errors.push_back({p.x(), p.y(), (found - q).norm(), true});
        }
      char stem[32];
      std::snprintf(stem, sizeof stem, "/worst_%02zu_", n + 1);
      sync::OverlayTexts texts;
      texts.left_title = "at the nominal place";
      texts.right_title = "where the map found puts it";
      texts.note = "pair " + std::to_string(one.index) + ": " + setting.kind + ", P95 " + std::to_string(one.p95_mm) + " mm; " + one.result.reason;
      graphics::write_png(options.out + stem + "overlay.png", sync::overlay_figure(body, before, after, texts));
      graphics::write_png(options.out + stem + "error.png", sync::misfit_figure(body, errors, 0.002, "|error| of the map found, " + setting.kind));
    }
  }
  void peers(const Pair& pair, const std::string& kind, const Registration& r) {
    sync::Transform pose = r.pose_only;
    if (!r.success) {  // the truth's own affine part, so that the peer is judged all the same
      pose.a = pair.truth.a;
      pose.t = pair.truth.t;
    }
    const PeerResult e = run_elastix(pair.green, pair.print, pose, options.parameters, options.out + "/elastix", options.threads);
    const std::vector<double> error = e.ran ? errors_mm(pair, e.print_from_green) : std::vector<double>{};
    note(kind, "elastix", e.ran, error, e.seconds);
    const Point centre(pair.green.width_m() / 2, pair.green.height_m() / 2);
    const PeerResult c = run_plain_ecc(pair.green, pair.print, pair.truth.a * centre + pair.truth.t - centre);
    const std::vector<double> ecc_error = c.ran ? errors_mm(pair, c.print_from_green) : std::vector<double>{};
    note(kind, "plain ECC", c.ran, ecc_error, c.seconds);
    std::printf("  elastix: median %.3f P95 %.3f mm, %.1f s; plain ECC: median %.3f P95 %.3f mm\n", s::at_quantile(error, 0.5),
                s::at_quantile(error, 0.95), e.seconds, s::at_quantile(ecc_error, 0.5), s::at_quantile(ecc_error, 0.95));
    std::fflush(stdout);
  }
  void unrelated() {
    int accepted = 0;
    double seconds = 0;
    for (int k = options.first; k < options.first + options.unrelated; ++k) {
      const std::size_t n = scenes.size(), a = static_cast<std::size_t>(k) % n, b = (a + 1 + static_cast<std::size_t>(k) / n % (n - 1)) % n;
      PairSettings settings;
      settings.portion = k / 2 % 2 == 1;
      settings.picture = k % 2 == 1;
      Pair pair = make_pair(scenes[a], settings, 5000 + static_cast<std::uint64_t>(k));
      pair.print = settings.picture ? scenes[b].luma : scenes[b].plan;
      double t = 0;
      const Registration r = ours(pair, t);
      seconds += t;
      if (!r.success) continue;
      ++accepted;
      std::printf("false success: %s on %s, confidence %.2f\n", scenes[a].name.c_str(), scenes[b].name.c_str(), r.confidence);
    }
    if (options.unrelated > 0)
      std::printf("unrelated pairs: %d, accepted %d, %.2f s each\n", options.unrelated, accepted, seconds / options.unrelated);
  }
  void table() {
    std::printf("\n| pairs | code | found | wrong | TRE median mm | TRE P95 mm | s per pair |\n|---|---|---|---|---|---|---|\n");
    std::map<std::string, Row> total;
    for (auto& [kind, codes] : rows)
      for (auto& [code, r] : codes) {
        std::printf("| %s | %s | %d/%d | %d | %.3f | %.3f | %.2f |\n", kind.c_str(), code.c_str(), r.found, r.pairs, r.wrong, r.mean_of(r.median),
                    r.mean_of(r.p95), r.mean_of(r.seconds));
        Row& t = total[code];
        t.found += r.found;
        t.pairs += r.pairs;
        t.wrong += r.wrong;
        t.median.insert(t.median.end(), r.median.begin(), r.median.end());
        t.p95.insert(t.p95.end(), r.p95.begin(), r.p95.end());
        t.seconds.insert(t.seconds.end(), r.seconds.begin(), r.seconds.end());
      }
    for (auto& [code, t] : total)
      std::printf("| all | %s | %d/%d | %d | %.3f | %.3f | %.2f |\n", code.c_str(), t.found, t.pairs, t.wrong, t.mean_of(t.median), t.mean_of(t.p95),
                  t.mean_of(t.seconds));
    std::printf("\nzones whose predicted error covers the true one: %d of %d (%.1f %%), with lost veins %d of %d\nleast Jacobian: %.3f\n", covered,
                zones, zones > 0 ? 100.0 * covered / zones : NAN, covered_lost, zones_lost, smallest_jacobian);
    if (whole_faces > 0) std::printf("\n| phase (mean of %d whole faces) | s |\n|---|---|\n", whole_faces);
    for (const sync::Phase& p : phases) std::printf("| %s | %.3f |\n", p.name.c_str(), p.seconds / whole_faces);
    if (total.count("elastix"))
      std::printf("ratio_to_elastix %.2f\n", total["elastix"].mean_of(total["elastix"].seconds) / total["ours"].mean_of(total["ours"].seconds));
  }
};

int run(int argc, char** argv) {
  Options o;
  for (int k = 1; k < argc; ++k) {
    const std::string a = argv[k];
    const auto value = [&]() -> std::string {
      if (k + 1 >= argc) throw std::invalid_argument(a + " needs a value");
      return argv[++k];
    };
    if (a == "--pairs")
      o.pairs = std::stoi(value());
    else if (a == "--first")
      o.first = std::stoi(value());
    else if (a == "--unrelated")
      o.unrelated = std::stoi(value());
    else if (a == "--prior-error-mm")
      o.prior_error_mm = std::stod(value());
    else if (a == "--worst")
      o.worst = std::stoi(value());
    else if (a == "--threads")
      o.threads = std::stoi(value());
    else if (a == "--out")
      o.out = value();
    else if (a == "--no-peers")
      o.peers = false;
    else if (a.rfind("--", 0) == 0)
      throw std::invalid_argument("unknown option " + a);
    else
      o.scenes.push_back(a);
  }
  if (o.scenes.size() < 2)
    throw std::invalid_argument(
        "usage: registration_bench [--pairs N] [--first N] [--unrelated N] [--worst N] [--prior-error-mm E] [--threads N] [--out DIR] [--no-peers] SCENE.png SCENE.png...");
  Runner runner;
  runner.options = o;
  for (const std::string& f : o.scenes) runner.scenes.push_back(load_scene(f));
  runner.related();
  runner.draw_worst();
  runner.unrelated();
  runner.table();
  return 0;
}
}  // namespace
}  // namespace venato::bench
int main(int argc, char** argv) {
  try {
    return venato::bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "registration_bench: %s\n", e.what());
    return 2;
  }
}
