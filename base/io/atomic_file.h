#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
namespace venato {

/// Writes a file so that the final name never shows half of it: `write(partial)` creates "<name>.partial-<pid>" in the same folder, then
/// fsync, rename, fsync of the folder. On any exception the partial file is removed and the exception goes on.
/// \throws WorkError naming path and reason (disk full, permission) when the operating system refuses.
void write_atomically(const std::filesystem::path& final_path, const std::function<void(const std::filesystem::path& partial)>& write);
void write_text_atomically(const std::filesystem::path& final_path, std::string_view text);
/// The two halves, for writers that stay open for long (H5Writer): the name to write to, and fsync + rename + fsync of the folder.
std::filesystem::path partial_path(const std::filesystem::path& final_path);
void commit_partial(const std::filesystem::path& partial, const std::filesystem::path& final_path);

/// Whole file as bytes. \throws UsageError naming the path when it is missing, a folder, or larger than `limit_bytes`.
std::string read_file(const std::filesystem::path& path, std::uintmax_t limit_bytes = 1ull << 30);

/// Creates the folder (and parents). \throws UsageError naming the path when it cannot be created or written to.
void make_output_folder(const std::filesystem::path& folder);

/// \throws WorkError "needs 3.2 GiB, 1.1 GiB free on …" when the file system of `folder` has less than `bytes` free.
void require_free_space(const std::filesystem::path& folder, std::uintmax_t bytes, std::string_view what_for);
}  // namespace venato
