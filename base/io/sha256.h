#pragma once
#include <filesystem>
#include <string>
#include <string_view>
namespace venato {
std::string sha256_hex(std::string_view bytes);
/// Of a file of any size, read in pieces. \throws WorkError naming the path when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);
}  // namespace venato
