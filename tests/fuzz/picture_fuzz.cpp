/// libFuzzer target of every picture reader (TIFF, PNG, JPEG): any bytes either load or are refused with a UsageError naming the file. Anything else
/// (another exception, a crash, more memory than the limits below allow) is a finding. Built and run by tests/fuzz/run.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "graphics/graphic.h"
#include "graphics/tiff/tiff_file.h"

namespace {
constexpr double kMaxPixels = 1 << 20, kMaxBytes = 4 << 20;  // small, so that memory stays bounded by what the readers promise
constexpr double kPitch_m = 1e-3;

template <class Read>
void attempt(const std::string& name, Read read) {
  try {
    read();
  } catch (const venato::UsageError& e) {
    if (std::string(e.what()).find(name) == std::string::npos) std::abort();  // the message must say which file
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("picture", MFD_CLOEXEC);  // a file without a disk
  static const std::string name = "/proc/self/fd/" + std::to_string(file);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  attempt(name, [] { venato::graphics::load_picture(name, kPitch_m, kMaxPixels); });
  const bool tiff = size > 4 && ((data[0] == 'I' && data[1] == 'I') || (data[0] == 'M' && data[1] == 'M'));
  if (!tiff) return 0;
  attempt(name, [] { venato::graphics::read_tiff_info(name); });
  attempt(name, [] { venato::graphics::read_tiff8(name, kMaxBytes); });
  attempt(name, [] { venato::graphics::read_tiff_f32(name, kMaxBytes); });
  return 0;
}
