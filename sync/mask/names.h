#pragma once
#include <string_view>
namespace venato::sync {
/// Whether a name can become part of a file name everywhere: 1 to 40 of A-Z a-z 0-9 _ -.
bool is_file_name_part(std::string_view name);
}  // namespace venato::sync
