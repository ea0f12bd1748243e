#pragma once
/// An output profile that has passed every check, and transforms between colour and inks. Internal to separate_by_profile.
#include <lcms2.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>
namespace venato::graphics::icc {

template <auto Close>
struct Closer {
  template <class T>
  void operator()(T* handle) const {
    Close(handle);
  }
};
using ContextHandle = std::unique_ptr<std::remove_pointer_t<cmsContext>, Closer<cmsDeleteContext>>;
using ProfileHandle = std::unique_ptr<void, Closer<cmsCloseProfile>>;
using TransformHandle = std::unique_ptr<void, Closer<cmsDeleteTransform>>;

/// One step of a chain of profiles and the intent it is entered by.
struct Step {
  cmsHPROFILE profile;
  cmsUInt32Number intent;
};

class OutputProfile {
 public:
  /// \throws UsageError, see separate_by_profile.h
  explicit OutputProfile(const std::filesystem::path& file);
  int inks() const { return inks_; }
  const std::string& description() const { return description_; }
  const std::vector<std::string>& ink_names() const { return names_; }
  /// 8 bit pixels, one channel per ink, 0 = no ink.
  cmsUInt32Number ink_format() const { return format_; }
  cmsHPROFILE handle() const { return profile_.get(); }
  cmsHPROFILE srgb() const { return srgb_.get(); }
  cmsHPROFILE lab() const { return lab_.get(); }
  /// May be shared between threads (cmsFLAGS_NOCACHE is added). \throws UsageError when the profile's tables are damaged
  TransformHandle transform(const std::vector<Step>& steps, cmsUInt32Number in, cmsUInt32Number out, cmsUInt32Number flags) const;

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  void check_class_and_colour_space();
  void check_tables() const;
  void read_description();
  void read_names();
  std::string file_;
  std::string bytes_;
  std::unique_ptr<std::string> log_;  ///< first message of Little CMS; at a fixed address, the context points to it
  ContextHandle context_;
  ProfileHandle profile_, srgb_, lab_;
  int inks_ = 0;
  cmsUInt32Number format_ = 0;
  std::string description_;
  std::vector<std::string> names_;
};
}  // namespace venato::graphics::icc
