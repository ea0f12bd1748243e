#include "tests/bench/start_file.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/io/atomic_file.h"

namespace venato::bench {
namespace {
constexpr double kFloorRoom_m = 1e-3, kHeadRoom_m = 8e-3;  // of the fixed box of the peers below the floor and above the highest grain

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
File open(const std::filesystem::path& path, const char* mode) {
  File file(std::fopen(path.c_str(), mode), &std::fclose);
  if (!file) throw UsageError(path.string() + ": " + std::strerror(errno));
  return file;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : name_(path.string()), file_(open(path, "r")) {}
  /// Next line that is not blank; an error at the end of the file.
  const char* line() {
    do {
      if (!std::fgets(buffer_, sizeof buffer_, file_.get())) fail("is cut short");
    } while (std::strspn(buffer_, " \t\r\n") == std::strlen(buffer_));
    return buffer_;
  }
  void until(const char* word) {
    while (std::strncmp(line(), word, std::strlen(word)) != 0) {
    }
  }
  void numbers(double* out, int count) {
    char* at = const_cast<char*>(line());
    for (int k = 0; k < count; ++k) {
      char* end = nullptr;
      out[k] = std::strtod(at, &end);
      if (end == at) fail(std::string("has a bad line: ") + buffer_);
      at = end;
    }
  }
  [[noreturn]] void fail(const std::string& why) const { throw UsageError(name_ + " " + why); }

 private:
  std::string name_;
  File file_;
  char buffer_[512] = {};
};
}  // namespace

void write_start(const std::filesystem::path& path, const StartState& state, double density) {
  double top = 0;
  for (const StartGrain& g : state.grains) top = std::max(top, g.position_m.z());
  write_atomically(path, [&](const std::filesystem::path& partial) {
    const File file = open(partial, "w");
    std::FILE* out = file.get();
    std::fprintf(out, "settled bed\n\n%zu atoms\n1 atom types\n\n", state.grains.size());
    std::fprintf(out, "0 %.15g xlo xhi\n0 %.15g ylo yhi\n%.15g %.15g zlo zhi\n\nAtoms\n\n", state.length_x_m, state.length_y_m, -kFloorRoom_m,
                 top + kHeadRoom_m);
    for (std::size_t k = 0; k < state.grains.size(); ++k) {
      const StartGrain& g = state.grains[k];
      std::fprintf(out, "%zu 1 %.15g %g %.15g %.15g %.15g\n", k + 1, g.diameter_m, density, g.position_m.x(), g.position_m.y(), g.position_m.z());
    }
    std::fprintf(out, "\nVelocities\n\n");
    for (std::size_t k = 0; k < state.grains.size(); ++k) {
      const Vec3 &v = state.grains[k].velocity_m_s, &w = state.grains[k].spin_rad_s;
      std::fprintf(out, "%zu %.15g %.15g %.15g %.15g %.15g %.15g\n", k + 1, v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
    }
    if (std::fflush(out) != 0 || std::ferror(out)) throw WorkError("cannot write " + path.string() + ": " + std::strerror(errno));
  });
}

StartState read_start(const std::filesystem::path& path) {
  Reader in(path);
  in.line();  // title
  double count = 0, limits[2], atom[7], motion[7];
  in.numbers(&count, 1);
  if (!(count >= 1 && count <= 1e9)) in.fail("does not begin with a number of atoms");
  in.line();  // atom types
  StartState state;
  in.numbers(limits, 2);
  state.length_x_m = limits[1] - limits[0];
  in.numbers(limits, 2);
  state.length_y_m = limits[1] - limits[0];
  in.until("Atoms");
  state.grains.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < state.grains.size(); ++k) {
    in.numbers(atom, 7);
    if (atom[0] != static_cast<double>(k + 1)) in.fail("has atoms out of order");
    state.grains[k].diameter_m = atom[2];
    state.grains[k].position_m = Vec3(atom[4], atom[5], atom[6]);
  }
  in.until("Velocities");
  for (std::size_t k = 0; k < state.grains.size(); ++k) {
    in.numbers(motion, 7);
    if (motion[0] != static_cast<double>(k + 1)) in.fail("has velocities out of order");
    state.grains[k].velocity_m_s = Vec3(motion[1], motion[2], motion[3]);
    state.grains[k].spin_rad_s = Vec3(motion[4], motion[5], motion[6]);
  }
  return state;
}

StartState tile_and_shear(const StartState& tile, int nx, int ny, double speed) {
  std::vector<double> z;
  for (const StartGrain& g : tile.grains) z.push_back(g.position_m.z());
  std::sort(z.begin(), z.end());
  const double height = z.empty() ? 1 : z[static_cast<std::size_t>(0.995 * static_cast<double>(z.size() - 1))];
  StartState bed;
  bed.length_x_m = tile.length_x_m * nx;
  bed.length_y_m = tile.length_y_m * ny;
  bed.grains.reserve(tile.grains.size() * static_cast<std::size_t>(nx * ny));
  for (int ix = 0; ix < nx; ++ix)
    for (int iy = 0; iy < ny; ++iy)
      for (StartGrain g : tile.grains) {
        g.position_m += Vec3(ix * tile.length_x_m, iy * tile.length_y_m, 0);
        g.velocity_m_s.x() += speed * std::clamp(1 - g.position_m.z() / height, 0.0, 1.0);
        bed.grains.push_back(g);
      }
  return bed;
}
}  // namespace venato::bench
