#pragma once
#include <filesystem>
namespace venato::line {

/// A run folder in the making: everything is written into a hidden folder inside OUT and moved to its final name at the end, so that a killed or
/// failed run leaves no half-written file under a final name, and an older result stays until the new one is complete.
class RunFolder {
 public:
  /// Creates OUT when missing; clears what runs that were killed left inside. \throws UsageError when OUT cannot be created or written to.
  explicit RunFolder(std::filesystem::path out);
  ~RunFolder();  ///< without publish(): removes the hidden folder, and OUT itself when this object created it and nothing else is in it
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  const std::filesystem::path& staging() const { return staging_; }
  const std::filesystem::path& final_path() const { return out_; }
  /// Moves every entry of the staging folder into OUT; folders replace folders of the same name. \throws WorkError.
  void publish();

 private:
  std::filesystem::path out_, staging_;
  bool created_ = false;
};
}  // namespace venato::line
