#pragma once
#include <filesystem>
#include <string>
#include <vector>
namespace venato::sync {

/// Files that must appear together: written into a hidden folder beside their final place and moved at the end.
/// Destroyed without publish(), it leaves nothing behind; what a killed program left is cleared by the next one.
class StagedFolder {
 public:
  /// \throws UsageError when `final_folder` cannot be made or written to.
  explicit StagedFolder(std::filesystem::path final_folder);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  const std::filesystem::path& path() const { return staging_; }
  /// Moves every staged file to the final folder, `last` (the sidecar that vouches for the others) at the end; an old `last` goes first, so that it
  /// never stands beside files it does not describe. If a move fails those already made are undone. \throws WorkError.
  void publish(const std::string& last);

 private:
  std::filesystem::path final_, staging_;
};
}  // namespace venato::sync
