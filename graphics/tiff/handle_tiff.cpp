#include <tiffio.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "base/error.h"
#include "graphics/tiff/handle.h"
namespace venato::graphics::detail {
namespace {
constexpr tmsize_t kMaxSingleAllocation_bytes = tmsize_t{1} << 32;

int keep_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  auto& log = *static_cast<TiffLog*>(user);
  if (!log.first_error.empty()) return 1;
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  log.first_error = text;
  return 1;
}
/// A tag that lies beyond the end of the file is only a warning to libtiff ("IO error during reading of …; tag ignored").
int note_cut_tags(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  if (std::strncmp(format, "IO error", 8) == 0) {
    char text[512];
    std::vsnprintf(text, sizeof text, format, arguments);
    static_cast<TiffLog*>(user)->cut_tag = text;
  }
  return 1;
}

struct Options {
  TIFFOpenOptions* o = TIFFOpenOptionsAlloc();
  explicit Options(TiffLog& log) {
    TIFFOpenOptionsSetErrorHandlerExtR(o, keep_error, &log);
    TIFFOpenOptionsSetWarningHandlerExtR(o, note_cut_tags, &log);
    TIFFOpenOptionsSetMaxSingleMemAlloc(o, kMaxSingleAllocation_bytes);
  }
  ~Options() { TIFFOpenOptionsFree(o); }
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;
};

struct Memory {
  std::vector<std::uint8_t>& data;
  std::size_t at = 0;
};
tmsize_t memory_read(thandle_t h, void* out, tmsize_t n) {
  auto& m = *static_cast<Memory*>(h);
  const std::size_t left = m.at < m.data.size() ? m.data.size() - m.at : 0;
  const std::size_t take = std::min(left, static_cast<std::size_t>(n));
  std::memcpy(out, m.data.data() + m.at, take);
  m.at += take;
  return static_cast<tmsize_t>(take);
}
tmsize_t memory_write(thandle_t h, void* in, tmsize_t n) {
  auto& m = *static_cast<Memory*>(h);
  const std::size_t end = m.at + static_cast<std::size_t>(n);
  if (end > m.data.size()) m.data.resize(end);
  std::memcpy(m.data.data() + m.at, in, static_cast<std::size_t>(n));
  m.at = end;
  return n;
}
toff_t memory_seek(thandle_t h, toff_t offset, int whence) {
  auto& m = *static_cast<Memory*>(h);
  const std::size_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? m.at : m.data.size();
  m.at = from + static_cast<std::size_t>(offset);
  return m.at;
}
int memory_close(thandle_t) { return 0; }
toff_t memory_size(thandle_t h) { return static_cast<Memory*>(h)->data.size(); }
}  // namespace

void CloseTiff::operator()(tiff* t) const { TIFFClose(t); }

TiffHandle open_tiff_reader(const std::filesystem::path& file, TiffLog& log) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw UsageError(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw UsageError(file.string() + ": is not a regular file");
  if (std::filesystem::file_size(file, error) == 0) throw UsageError(file.string() + ": is empty (0 bytes)");
  Options options(log);
  // m: no memory mapping, so that a file cut while it is read gives an error and not a SIGBUS.
  TiffHandle t(TIFFOpenExt(file.c_str(), "rm", options.o));
  if (!t) throw UsageError(file.string() + ": cannot be read as TIFF: " + log.reason("unknown reason"));
  return t;
}

TiffHandle open_tiff_writer(int descriptor, const std::string& name, bool big_tiff, TiffLog& log) {
  Options options(log);
  return TiffHandle(TIFFFdOpenExt(descriptor, name.c_str(), big_tiff ? "w8" : "w4", options.o));
}

std::span<const std::uint8_t> StripEncoder::encode(const TiffInfo& info, std::span<const std::uint8_t> rows) {
  const std::int64_t row_bytes = info.width * info.channels * bytes_per_sample(info);
  if (info.compression == TiffCompression::deflate && bytes_per_sample(info) == 1)
    return deflate_.encode(rows, static_cast<std::size_t>(row_bytes), static_cast<std::size_t>(info.channels));
  const std::int64_t height = static_cast<std::int64_t>(rows.size()) / row_bytes;
  memory_.clear();
  memory_.reserve(rows.size() + rows.size() / 2 + 4096);
  Memory memory{memory_};
  TiffLog log;
  Options options(log);
  TIFF* t = TIFFClientOpenExt("strip", "w", &memory, memory_read, memory_write, memory_seek, memory_close, memory_size, nullptr, nullptr, options.o);
  if (!t) throw WorkError("TIFF strip: " + log.reason("cannot start the encoder"));
  set_coding_tags(t, info, height);
  // libtiff's signature is not const, but it works on a copy when a predictor is set.
  const bool ok =
      TIFFWriteEncodedStrip(t, 0, const_cast<std::uint8_t*>(rows.data()), static_cast<tmsize_t>(rows.size())) == static_cast<tmsize_t>(rows.size());
  const std::uint64_t offset = ok ? TIFFGetStrileOffset(t, 0) : 0, count = ok ? TIFFGetStrileByteCount(t, 0) : 0;
  TIFFCleanup(t);  // not TIFFClose: the directory of this throw-away file is not needed
  if (!ok || count == 0 || offset + count > memory_.size()) throw WorkError("TIFF strip: " + log.reason("compression failed"));
  return {memory_.data() + offset, static_cast<std::size_t>(count)};
}
}  // namespace venato::graphics::detail
