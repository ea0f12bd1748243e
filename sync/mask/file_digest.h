#pragma once
#include <filesystem>
#include <string>
namespace venato::sync {
/// SHA-256 of a file of any size, hex, read in pieces. \throws WorkError naming the path.
std::string file_sha256(const std::filesystem::path& path);
}  // namespace venato::sync
