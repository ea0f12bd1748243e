#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "base/io/sha256.h"
namespace venato {

/// SHA-256 of (kind, canonical inputs, parent keys, code version of what computes it), hex.
std::string store_key(std::string_view kind, std::string_view canonical_inputs, const std::vector<std::string>& parents,
                      std::string_view code_version);

/// Content-addressed folder of finished results (operators) and of work in progress (DEM checkpoints).
/// An entry <root>/<kind>/<first 2 hex>/<key>.h5 appears only when complete (temp file, fsync, atomic rename), together with a manifest
/// (<key>.json: sha256 of the file, size, code version). A file that does not match its manifest is set aside and counts as missing.
class Store {
 public:
  /// Default root: $VENATO_STORE, else $XDG_CACHE_HOME/venato, else ~/.cache/venato. \throws UsageError when it cannot be created.
  explicit Store(std::filesystem::path root);
  static std::filesystem::path default_root();
  const std::filesystem::path& root() const { return root_; }

  std::optional<std::filesystem::path> find(std::string_view kind, const std::string& key) const;
  /// `write(tmp)` makes the file; returns the final path.
  std::filesystem::path put(std::string_view kind, const std::string& key, std::string_view code_version,
                            const std::function<void(const std::filesystem::path&)>& write);
  /// Where work in progress for this key may keep its checkpoint; the folder exists, the file need not.
  std::filesystem::path checkpoint_path(std::string_view kind, const std::string& key) const;
  void drop_checkpoint(std::string_view kind, const std::string& key) const;

 private:
  std::filesystem::path root_;
};
}  // namespace venato
