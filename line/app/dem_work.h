#pragma once
#include <filesystem>
#include "base/io/file_lock.h"
#include "base/store/store.h"
namespace venato::line::app {

/// Where one DEM case keeps its work in progress: checkpoint, and the ParaView files and pictures made so far (an index of them must find those of
/// the part before an interruption). In the store under the case's content, locked against a second process with the same case.
class DemWork {
 public:
  /// \throws WorkError when another process is running this very case.
  DemWork(const Store& store, const std::string& key, const std::string& case_name);
  ~DemWork();  ///< removes its folder when nothing is in it
  DemWork(const DemWork&) = delete;
  DemWork& operator=(const DemWork&) = delete;
  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path checkpoint() const { return folder_ / "case.checkpoint"; }
  bool has_checkpoint() const { return std::filesystem::exists(checkpoint()); }
  void clear();  ///< everything made so far
  /// Puts a sub-folder's files into `target` (hard links where the file system has them, else copies); nothing when there is none.
  void place(const std::string& name, const std::filesystem::path& target) const;

 private:
  std::filesystem::path folder_;
  FileLock lock_;
};
}  // namespace venato::line::app
