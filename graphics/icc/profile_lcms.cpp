#include "graphics/icc/profile_lcms.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>

#include "base/error.h"
namespace venato::graphics::icc {
namespace {
constexpr std::size_t kHeader_bytes = 128;
constexpr std::uintmax_t kLargest_bytes = std::uintmax_t{256} << 20;
constexpr const char* kWanted =
    "; wanted: an ICC output (printer) profile with 1 to 15 inks (GRAY, CMYK or 2CLR to FCLR) and tables both ways (AToB, BToA)";

void remember_first(cmsContext context, cmsUInt32Number, const char* text) {
  auto& log = *static_cast<std::string*>(cmsGetContextUserData(context));
  if (log.empty()) log = text;
}

std::string signature_text(cmsUInt32Number signature) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    const auto c = static_cast<unsigned char>(signature >> shift);
    text += std::isprint(c) ? static_cast<char>(c) : '?';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string class_text(cmsProfileClassSignature kind) {
  switch (kind) {
    case cmsSigDisplayClass:
      return "a display profile";
    case cmsSigInputClass:
      return "a profile of a scanner or camera";
    case cmsSigLinkClass:
      return "a device link";
    case cmsSigAbstractClass:
      return "an abstract profile";
    case cmsSigColorSpaceClass:
      return "a colour space profile";
    case cmsSigNamedColorClass:
      return "a named colour profile";
    default:
      return "a profile of class '" + signature_text(kind) + "'";
  }
}

/// 0 for a colour space that is not one of inks.
int inks_of(cmsColorSpaceSignature space) {
  if (space == cmsSigGrayData) return 1;
  if (space == cmsSigCmykData) return 4;
  const std::string text = signature_text(space);  // "6CLR" of the standard, "MCH6" of older makers
  const std::string digits = "0123456789ABCDEF";
  if (text.size() != 4) return 0;
  const char digit = text.substr(1) == "CLR" ? text[0] : text.substr(0, 3) == "MCH" ? text[3] : '0';
  const std::size_t n = digits.find(digit);
  return n == std::string::npos ? 0 : static_cast<int>(n);
}

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(file, error);
  if (!regular) throw UsageError(file.string() + ": " + (std::filesystem::exists(file, error) ? "is not a file" : "does not exist") + kWanted);
  if (std::filesystem::file_size(file, error) > kLargest_bytes) throw UsageError(file.string() + ": is over 256 MiB" + kWanted);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw UsageError(file.string() + ": cannot be read" + kWanted);
  return {std::istreambuf_iterator<char>(in), {}};
}
}  // namespace

void OutputProfile::refuse(const std::string& what) const { throw UsageError(file_ + ": " + what + kWanted); }

OutputProfile::OutputProfile(const std::filesystem::path& file)
    : file_(file.string()), bytes_(read_bytes(file)), log_(std::make_unique<std::string>()), context_(cmsCreateContext(nullptr, log_.get())) {
  cmsSetLogErrorHandlerTHR(context_.get(), remember_first);
  if (bytes_.size() < kHeader_bytes + 4 || bytes_.compare(36, 4, "acsp") != 0) refuse("is not an ICC profile (no 'acsp' at byte 36)");
  std::size_t told = 0;
  for (std::size_t k = 0; k < 4; ++k) told = told << 8 | static_cast<unsigned char>(bytes_[k]);
  // Little CMS skips tags beyond the end without a word.
  if (told > bytes_.size())
    refuse("is truncated: " + std::to_string(bytes_.size()) + " of the " + std::to_string(told) + " bytes that its header tells");
  profile_.reset(cmsOpenProfileFromMemTHR(context_.get(), bytes_.data(), static_cast<cmsUInt32Number>(bytes_.size())));
  if (!profile_) refuse("is a damaged ICC profile (" + *log_ + ")");
  check_class_and_colour_space();
  check_tables();
  read_description();
  read_names();
  srgb_.reset(cmsCreate_sRGBProfileTHR(context_.get()));
  lab_.reset(cmsCreateLab4ProfileTHR(context_.get(), nullptr));
  const cmsUInt32Number grey = COLORSPACE_SH(PT_GRAY) | FLAVOR_SH(1);  // grey profiles count light, not ink
  format_ =
      (cmsGetColorSpace(handle()) == cmsSigGrayData ? grey : COLORSPACE_SH(PT_ANY)) | CHANNELS_SH(static_cast<cmsUInt32Number>(inks_)) | BYTES_SH(1);
}

void OutputProfile::check_class_and_colour_space() {
  const auto space = cmsGetColorSpace(handle());
  const std::string of = " (colour space '" + signature_text(space) + "')";
  if (cmsGetDeviceClass(handle()) != cmsSigOutputClass) refuse("is " + class_text(cmsGetDeviceClass(handle())) + of);
  inks_ = inks_of(space);
  if (inks_ == 0) refuse("is an output profile, but not one of 1 to 15 inks" + of);
}

void OutputProfile::check_tables() const {
  if (cmsGetColorSpace(handle()) == cmsSigGrayData && cmsIsTag(handle(), cmsSigGrayTRCTag)) return;  // one curve serves both ways
  if (!cmsIsTag(handle(), cmsSigBToA0Tag)) refuse("has no table from colour to inks (BToA0)");
  if (!cmsIsTag(handle(), cmsSigAToB0Tag)) refuse("has no table from inks to colour (AToB0)");
}

void OutputProfile::read_description() {
  std::array<char, 512> text{};
  cmsGetProfileInfoASCII(handle(), cmsInfoDescription, "en", "US", text.data(), static_cast<cmsUInt32Number>(text.size() - 1));
  description_ = text.data();
  for (char& c : description_)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  if (description_.empty()) description_ = "(the profile has no description)";
}

void OutputProfile::read_names() {
  const auto space = cmsGetColorSpace(handle());
  if (space == cmsSigGrayData) names_ = {"black"};
  if (space == cmsSigCmykData) names_ = {"cyan", "magenta", "yellow", "black"};
  for (int k = static_cast<int>(names_.size()); k < inks_; ++k) names_.push_back("ink_" + std::to_string(k + 1));
  if (!cmsIsTag(handle(), cmsSigColorantTableTag)) return;
  const auto* table = static_cast<const cmsNAMEDCOLORLIST*>(cmsReadTag(handle(), cmsSigColorantTableTag));
  if (!table) refuse("has a damaged colorant table 'clrt' (" + *log_ + ")");
  if (cmsNamedColorCount(table) != static_cast<cmsUInt32Number>(inks_))
    refuse("names " + std::to_string(cmsNamedColorCount(table)) + " inks in its colorant table 'clrt', but has " + std::to_string(inks_));
  for (int k = 0; k < inks_; ++k) {
    std::array<char, cmsMAX_PATH> text{};
    cmsNamedColorInfo(table, static_cast<cmsUInt32Number>(k), text.data(), nullptr, nullptr, nullptr, nullptr);
    std::string name = std::string(text.data()).substr(0, 36);  // names become file names of at most 40 letters
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
    if (name.empty()) continue;
    const auto before = names_.begin() + k;
    names_[static_cast<std::size_t>(k)] = std::find(names_.begin(), before, name) == before ? name : name + "_" + std::to_string(k + 1);
  }
}

TransformHandle OutputProfile::transform(const std::vector<Step>& steps, cmsUInt32Number in, cmsUInt32Number out, cmsUInt32Number flags) const {
  std::vector<cmsHPROFILE> profiles;
  std::vector<cmsUInt32Number> intents;
  for (const Step& s : steps) {
    profiles.push_back(s.profile);
    intents.push_back(s.intent);
  }
  std::vector<cmsBool> black_point(steps.size(), FALSE);
  std::vector<cmsFloat64Number> adaptation(steps.size(), 1.0);
  log_->clear();
  TransformHandle t(cmsCreateExtendedTransform(context_.get(), static_cast<cmsUInt32Number>(steps.size()), profiles.data(), black_point.data(),
                                               intents.data(), adaptation.data(), nullptr, 0, in, out, flags | cmsFLAGS_NOCACHE));
  if (!t) refuse("is a damaged ICC profile (" + (log_->empty() ? "its tables cannot be used" : *log_) + ")");
  return t;
}
}  // namespace venato::graphics::icc
