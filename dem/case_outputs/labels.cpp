#include "dem/case_outputs/labels.h"

namespace venato::dem {
namespace {
template <class T>
std::string label(const std::vector<T>& items, std::size_t k, const char* kind) {
  const std::string& name = items.at(k).name;
  if (name.empty()) return std::string(kind) + std::to_string(k);
  for (std::size_t before = 0; before < k; ++before)
    if (items[before].name == name) return name + "_" + std::to_string(k);
  return name;
}
}  // namespace

std::string counter_label(const Case& c, std::size_t k) { return label(c.counters, k, "counter"); }
std::string wall_label(const Case& c, std::size_t k) { return label(c.walls, k, "wall"); }
std::string powder_label(const Case& c, std::size_t k) { return label(c.powders, k, "powder"); }
}  // namespace venato::dem
