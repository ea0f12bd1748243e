#include "graphics/tiff/handle.h"
namespace venato::graphics {

struct StripCoder::Impl {
  detail::StripEncoder encoder;
};
StripCoder::StripCoder() : impl_(std::make_unique<Impl>()) {}
StripCoder::~StripCoder() = default;
StripCoder::StripCoder(StripCoder&&) noexcept = default;
std::span<const std::uint8_t> StripCoder::encode(const TiffInfo& info, std::span<const std::uint8_t> rows) { return impl_->encoder.encode(info, rows); }
}  // namespace venato::graphics
