#include "line/products/spectral_convolution.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "base/expects.h"
#include "line/products/layer_mixing.h"
#include "line/products/spectral/mirror_dct.h"

namespace venato::line {
namespace {
constexpr std::size_t kB = BatchFft::kBatch;

struct Shape {
  std::size_t nx, ny, layers_in, layers_out, pairs;  // pairs of powders
  bool each_layer_alike;
};

// The two fields that travel together; the second may be missing (odd number of powders).
struct PowderPair {
  std::vector<double>*first, *second;
};
PowderPair powder_pair(Bed& bed, std::size_t pair) {
  return {&bed.mass[2 * pair], 2 * pair + 1 < bed.mass.size() ? &bed.mass[2 * pair + 1] : nullptr};
}

void transform_across(Bed& bed, std::size_t layers, bool forward, int threads) {
  const std::size_t nx = static_cast<std::size_t>(bed.grid.nx), rows = static_cast<std::size_t>(bed.grid.ny) * layers, blocks = (rows + kB - 1) / kB;
  const MirrorDct dct(bed.grid.nx);
  const std::size_t pairs = (bed.mass.size() + 1) / 2;
#pragma omp parallel num_threads(threads)
  {
    std::vector<double> re(nx * kB), im(nx * kB), work(dct.work_size());
#pragma omp for schedule(dynamic, 8)
    for (std::size_t task = 0; task < blocks * pairs; ++task) {
      const PowderPair powders = powder_pair(bed, task / blocks);
      const std::size_t row0 = task % blocks * kB, count = std::min(kB, rows - row0);
      const auto load = [&](const std::vector<double>* field, std::vector<double>& lanes) {
        if (!field || count < kB) std::fill(lanes.begin(), lanes.end(), 0.0);
        for (std::size_t b = 0; field && b < count; ++b) {
          const double* row = field->data() + (row0 + b) * nx;
          for (std::size_t i = 0; i < nx; ++i) lanes[i * kB + b] = row[i];
        }
      };
      load(powders.first, re);
      load(powders.second, im);
      forward ? dct.forward(re.data(), im.data(), work.data()) : dct.inverse(re.data(), im.data(), work.data());
      const auto save = [&](std::vector<double>* field, const std::vector<double>& lanes) {
        for (std::size_t b = 0; field && b < count; ++b) {
          double* row = field->data() + (row0 + b) * nx;
          for (std::size_t i = 0; i < nx; ++i) row[i] = lanes[i * kB + b];
        }
      };
      save(powders.first, re);
      save(powders.second, im);
    }
  }
}

// Everything one thread needs for one block of 8 cosine columns.
class ColumnBlock {
 public:
  ColumnBlock(Bed& bed, const BedKernel& kernel, const Shape& shape, const BatchFft& fft)
      : bed_(bed), kernel_(kernel), shape_(shape), fft_(fft), length_(static_cast<std::size_t>(fft.size()) * kB) {
    in_.resize(shape.pairs * shape.layers_in * 2 * length_);
    if (!shape.each_layer_alike) out_.resize(shape.pairs * shape.layers_out * 2 * length_);
    packed_.resize(2 * length_);
    work_.resize(fft.work_size());
    cosine_.resize(static_cast<std::size_t>(kernel.n_x) * kB);
  }

  void run(std::size_t column) {
    column_ = column;
    lanes_ = std::min(kB, shape_.nx - column);
    for (int e = 0; e < kernel_.n_x; ++e)
      for (std::size_t b = 0; b < kB; ++b) {
        const auto turns = static_cast<double>((column + b) * static_cast<std::size_t>(e) % (2 * shape_.nx)) / static_cast<double>(shape_.nx);
        cosine_[static_cast<std::size_t>(e) * kB + b] = (e == 0 ? 1.0 : 2.0) * std::cos(std::numbers::pi * turns);
      }
    for (std::size_t p = 0; p < shape_.pairs; ++p)
      for (std::size_t z = 0; z < shape_.layers_in; ++z) load(p, z);
    if (shape_.each_layer_alike) {
      pack(0, 0, 1);
      for (std::size_t i = 0; i < shape_.pairs * shape_.layers_in; ++i)
        multiply(fft_.size(), {packed_.data(), packed_.data() + length_}, spectrum(in_, i));
    } else {
      mix();
    }
    for (std::size_t p = 0; p < shape_.pairs; ++p)
      for (std::size_t z = 0; z < shape_.layers_out; ++z) save(p, z);
  }

 private:
  Spectrum spectrum(std::vector<double>& store, std::size_t i) const {
    return {store.data() + 2 * i * length_, store.data() + (2 * i + 1) * length_};
  }

  void load(std::size_t p, std::size_t z) {
    const Spectrum s = spectrum(in_, p * shape_.layers_in + z);
    std::memset(s.re, 0, 2 * length_ * sizeof(double));
    const PowderPair powders = powder_pair(bed_, p);
    for (std::size_t y = 0; y < shape_.ny; ++y) {
      const std::size_t at = (z * shape_.ny + y) * shape_.nx + column_;
      std::memcpy(s.re + y * kB, powders.first->data() + at, lanes_ * sizeof(double));
      if (powders.second) std::memcpy(s.im + y * kB, powders.second->data() + at, lanes_ * sizeof(double));
    }
    fft_.forward(s.re, s.im, work_.data());
  }

  // Transform of the kernels zin -> zout and zin -> zout + 1 as real and imaginary part. false: both are zero.
  bool pack(int zin, int zout, int count) {
    std::fill(packed_.begin(), packed_.end(), 0.0);
    const std::size_t n_x = static_cast<std::size_t>(kernel_.n_x), size = static_cast<std::size_t>(kernel_.n_y) * n_x;
    bool any = false;
    for (int k = 0; k < count; ++k) {
      const double* weight = kernel_.pair(zin, zout + k);
      if (std::all_of(weight, weight + size, [](double w) { return w == 0; })) continue;
      any = true;
      double* target = packed_.data() + static_cast<std::size_t>(k) * length_;
      for (int r = 0; r < kernel_.n_y; ++r)  // rows beyond one period fold back onto it
        cosine_sum(kernel_.n_x, weight + static_cast<std::size_t>(r) * n_x, cosine_.data(), target + static_cast<std::size_t>(r) % shape_.ny * kB);
    }
    if (any) fft_.forward(packed_.data(), packed_.data() + length_, work_.data());
    return any;
  }

  void mix() {
    std::fill(out_.begin(), out_.end(), 0.0);
    for (int zin = 0; zin < kernel_.nz_in; ++zin)
      for (int zout = 0; zout < kernel_.nz_out; zout += 2) {
        const int count = std::min(2, kernel_.nz_out - zout);
        if (!pack(zin, zout, count)) continue;
        for (std::size_t p = 0; p < shape_.pairs; ++p) {
          const Spectrum in = spectrum(in_, p * shape_.layers_in + static_cast<std::size_t>(zin));
          const std::size_t at = p * shape_.layers_out + static_cast<std::size_t>(zout);
          add_products(fft_.size(), {packed_.data(), packed_.data() + length_}, {in.re, in.im}, spectrum(out_, at),
                       count == 2 ? spectrum(out_, at + 1) : Spectrum{nullptr, nullptr});
        }
      }
  }

  void save(std::size_t p, std::size_t z) {
    const Spectrum s = spectrum(shape_.each_layer_alike ? in_ : out_, p * shape_.layers_out + z);
    fft_.inverse(s.re, s.im, work_.data());
    const std::size_t ny = shape_.ny, n = static_cast<std::size_t>(fft_.size());
    const double scale = 1.0 / static_cast<double>(n);
    for (std::size_t j = 0; j < n; ++j)  // the tail of the padded product belongs to the next period; then to SI
      for (std::size_t b = 0; b < kB; ++b) {
        const std::size_t to = (j < ny ? j : j - ny) * kB + b;
        s.re[to] = (j < ny ? 0.0 : s.re[to]) + s.re[j * kB + b] * scale;
        s.im[to] = (j < ny ? 0.0 : s.im[to]) + s.im[j * kB + b] * scale;
      }
    const PowderPair powders = powder_pair(bed_, p);
    const auto period = static_cast<long long>(ny);
    const auto shift = static_cast<std::size_t>((kernel_.y_offset % period + period) % period);
    for (std::size_t y = 0; y < ny; ++y) {
      const std::size_t at = (z * ny + (y + shift) % ny) * shape_.nx + column_;
      std::memcpy(powders.first->data() + at, s.re + y * kB, lanes_ * sizeof(double));
      if (powders.second) std::memcpy(powders.second->data() + at, s.im + y * kB, lanes_ * sizeof(double));
    }
  }

  Bed& bed_;
  const BedKernel& kernel_;
  const Shape& shape_;
  const BatchFft& fft_;
  std::size_t length_, column_ = 0, lanes_ = 0;
  std::vector<double> in_, out_, packed_, work_, cosine_;
};
}  // namespace

void convolve_in_place(Bed& bed, const BedKernel& kernel, int threads) {
  const bool alike = kernel.nz_in == 1 && kernel.nz_out == 1;
  VENATO_EXPECTS(threads >= 1 && (alike || kernel.nz_in == bed.grid.nz));
  const std::size_t layers = static_cast<std::size_t>(bed.grid.nz);
  const Shape shape{static_cast<std::size_t>(bed.grid.nx),
                    static_cast<std::size_t>(bed.grid.ny),
                    layers,
                    alike ? layers : static_cast<std::size_t>(kernel.nz_out),
                    (bed.mass.size() + 1) / 2,
                    alike};
  if (shape.layers_out > layers)
    for (auto& powder : bed.mass) powder.resize(shape.layers_out * bed.grid.columns());
  transform_across(bed, layers, true, threads);

  const int ny = bed.grid.ny;
  const int support = std::min(kernel.n_y, ny);
  // A period that factors well is its own transform length; otherwise pad, and fold what runs over.
  const BatchFft fft(next_smooth_size(ny) == ny ? ny : next_smooth_size(ny + support - 1));
  const std::size_t blocks = (shape.nx + kB - 1) / kB;
#pragma omp parallel num_threads(threads)
  {
    ColumnBlock block(bed, kernel, shape, fft);
#pragma omp for schedule(dynamic, 1)
    for (std::size_t i = 0; i < blocks; ++i) block.run(i * kB);
  }

  for (auto& powder : bed.mass) powder.resize(shape.layers_out * bed.grid.columns());
  bed.grid.nz = static_cast<int>(shape.layers_out);
  transform_across(bed, shape.layers_out, false, threads);
}
}  // namespace venato::line
