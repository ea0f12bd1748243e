#include <fcntl.h>
#include <omp.h>
#include <tiffio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>

#include "base/error.h"
#include "base/units.h"
#include "graphics/tiff/handle.h"
namespace venato::graphics {
namespace {
constexpr int kStripsPerThread = 4;  // in flight at once: 4 strips of 64 rows at 24 000 px x 6 inks are 37 MB a thread
constexpr double kClassicTiffLimit_bytes = 4294967295.0;

void sync_folder(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int d = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (d < 0) return;  // a file system without folder handles: the rename itself has succeeded
  ::fsync(d);
  ::close(d);
}
}  // namespace

struct TiffStripWriter::Impl {
  std::filesystem::path final_path, partial;
  TiffInfo info;
  int threads;
  std::size_t row_bytes = 0, strip_bytes = 0;
  std::vector<std::uint8_t> pending;  // rows that do not fill a batch yet
  std::int64_t rows_taken = 0, strips_written = 0;
  int sync_descriptor = -1;
  detail::TiffLog log;
  detail::TiffHandle tif;
  std::vector<detail::StripEncoder> encoders;
  bool done = false;

  [[noreturn]] void fail(const std::string& reason) const { throw WorkError(final_path.string() + ": cannot be written: " + reason); }

  void discard() noexcept {
    if (done) return;
    tif.reset();
    if (sync_descriptor >= 0) ::close(sync_descriptor);
    sync_descriptor = -1;
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    done = true;
  }
  /// Strips of `rows` (all full but perhaps the last): compressed side by side, written in order.
  void write_strips(std::span<const std::uint8_t> rows) {
    const std::size_t batch = encoders.size();
    for (std::size_t start = 0; start < rows.size(); start += batch * strip_bytes) {
      const std::size_t left = rows.size() - start;
      const int n = static_cast<int>(std::min(batch, (left + strip_bytes - 1) / strip_bytes));
      std::vector<std::span<const std::uint8_t>> coded(static_cast<std::size_t>(n));
      std::exception_ptr error;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
      for (int k = 0; k < n; ++k) {
        const auto s = static_cast<std::size_t>(k);
        try {
          coded[s] = encoders[s].encode(info, rows.subspan(start + s * strip_bytes, std::min(strip_bytes, left - s * strip_bytes)));
        } catch (...) {
#pragma omp critical(venato_tiff_strip)
          error = std::current_exception();
        }
      }
      if (error) std::rethrow_exception(error);
      for (const auto& c : coded) append(c);
    }
  }
  void append(std::span<const std::uint8_t> strip) {
    errno = 0;
    const auto size = static_cast<tmsize_t>(strip.size());
    if (TIFFWriteRawStrip(tif.get(), static_cast<std::uint32_t>(strips_written), const_cast<std::uint8_t*>(strip.data()), size) != size)
      fail(errno ? std::strerror(errno) : log.reason("write failed"));
    ++strips_written;
  }
};

TiffStripWriter::TiffStripWriter(std::filesystem::path final_path, const TiffInfo& info, int threads) : impl_(std::make_unique<Impl>()) {
  VENATO_EXPECTS(info.width > 0 && info.height > 0 && info.width <= 0x7fffffff && info.height <= 0x7fffffff);
  VENATO_EXPECTS(info.channels > 0 && info.channels <= 64 && info.rows_per_strip > 0 && threads > 0);
  VENATO_EXPECTS(info.kind != TiffKind::rgb || info.channels >= 3);
  VENATO_EXPECTS(info.kind != TiffKind::separated || info.ink_names.size() == static_cast<std::size_t>(info.channels));
  VENATO_EXPECTS(info.no_ink_value == 0 || info.no_ink_value == 255);
  Impl& m = *impl_;
  m.final_path = std::move(final_path);
  m.partial = m.final_path;
  m.partial += ".partial-" + std::to_string(::getpid());
  m.info = info;
  m.threads = threads;
  m.row_bytes = static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.channels * detail::bytes_per_sample(info));
  m.strip_bytes = m.row_bytes * static_cast<std::size_t>(info.rows_per_strip);
  m.encoders.resize(static_cast<std::size_t>(threads * kStripsPerThread));
  const double raw_bytes = static_cast<double>(m.row_bytes) * static_cast<double>(info.height);
  if (!info.big_tiff && info.compression == TiffCompression::none && raw_bytes > kClassicTiffLimit_bytes)
    m.fail("uncompressed data are over 4 GiB, the end of classic TIFF; use BigTIFF or a compression");
  const int descriptor = ::open(m.partial.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) m.fail(std::strerror(errno));
  m.sync_descriptor = ::dup(descriptor);
  m.tif = detail::open_tiff_writer(descriptor, m.partial.string(), info.big_tiff, m.log);
  if (!m.tif) {
    ::close(descriptor);
    m.discard();
    m.fail(m.log.reason("cannot start"));
  }
  detail::set_coding_tags(m.tif.get(), info, info.height);
  detail::set_description_tags(m.tif.get(), info);
  if (!m.log.first_error.empty()) {
    m.discard();
    m.fail(m.log.first_error);
  }
}

TiffStripWriter::~TiffStripWriter() { impl_->discard(); }

void TiffStripWriter::write_rows(std::span<const std::uint8_t> rows) {
  Impl& m = *impl_;
  VENATO_EXPECTS(!m.done && rows.size() % m.row_bytes == 0);
  m.rows_taken += static_cast<std::int64_t>(rows.size() / m.row_bytes);
  VENATO_EXPECTS(m.rows_taken <= m.info.height);
  try {
    const std::size_t batch_bytes = m.encoders.size() * m.strip_bytes;
    if (!m.pending.empty()) {  // top up to a whole batch first, so that strips never straddle a call
      const std::size_t take = std::min(rows.size(), batch_bytes - m.pending.size());
      m.pending.insert(m.pending.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(take));
      rows = rows.subspan(take);
      if (m.pending.size() < batch_bytes) return;
      m.write_strips(m.pending);
      m.pending.clear();
    }
    const std::size_t direct = rows.size() / m.strip_bytes * m.strip_bytes;
    m.write_strips(rows.first(direct));
    m.pending.assign(rows.begin() + static_cast<std::ptrdiff_t>(direct), rows.end());
  } catch (...) {
    m.discard();
    throw;
  }
}

void TiffStripWriter::write_coded(std::span<const std::uint8_t> strip, int rows) {
  Impl& m = *impl_;
  const std::int64_t left = m.info.height - m.rows_taken;
  VENATO_EXPECTS(!m.done && m.pending.empty() && rows > 0 && rows == std::min<std::int64_t>(m.info.rows_per_strip, left));
  m.rows_taken += rows;
  try {
    m.append(strip);
  } catch (...) {
    m.discard();
    throw;
  }
}

void TiffStripWriter::close() {
  Impl& m = *impl_;
  VENATO_EXPECTS(!m.done && m.rows_taken == m.info.height);
  try {
    m.write_strips(m.pending);
    errno = 0;
    if (!TIFFWriteDirectory(m.tif.get()) || !m.log.first_error.empty()) m.fail(errno ? std::strerror(errno) : m.log.reason("write failed"));
    m.tif.reset();
    if (::fsync(m.sync_descriptor) != 0) m.fail(std::strerror(errno));
    std::error_code error;
    std::filesystem::rename(m.partial, m.final_path, error);
    if (error) m.fail(error.message());
  } catch (...) {
    m.discard();
    throw;
  }
  ::close(m.sync_descriptor);
  m.done = true;
  sync_folder(m.final_path);
}

namespace {
template <class T>
void write_raster(const std::filesystem::path& file, const Raster<T>& image, TiffInfo info, int threads) {
  info.width = image.width;
  info.height = image.height;
  info.channels = image.channels;
  if (info.dpi <= 0 && image.pitch_m > 0) info.dpi = kMetresPerInch / image.pitch_m;
  TiffStripWriter writer(file, info, threads);
  writer.write_rows({reinterpret_cast<const std::uint8_t*>(image.data.data()), image.data.size() * sizeof(T)});
  writer.close();
}
}  // namespace

void write_tiff(const std::filesystem::path& file, const Raster8& image, TiffInfo info, int threads) {
  VENATO_EXPECTS(info.kind != TiffKind::fractions_f32);
  write_raster(file, image, std::move(info), threads);
}
void write_tiff(const std::filesystem::path& file, const RasterF& image, TiffInfo info, int threads) {
  info.kind = TiffKind::fractions_f32;
  write_raster(file, image, std::move(info), threads);
}
}  // namespace venato::graphics
