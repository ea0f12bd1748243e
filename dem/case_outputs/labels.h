#pragma once
#include <string>
#include "dem/case.h"
namespace venato::dem {
/// Name of counter or wall k for files and columns: its own, or with its number when that is empty or used before.
std::string counter_label(const Case& c, std::size_t k);
std::string wall_label(const Case& c, std::size_t k);
std::string powder_label(const Case& c, std::size_t k);
}  // namespace venato::dem
