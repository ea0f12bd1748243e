#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include "base/config/json_value.h"
#include "base/error.h"
namespace venato {

inline constexpr std::size_t kMaxConfigBytes = 4u << 20;  ///< the largest real configs are below 100 kB
inline constexpr int kMaxJsonDepth = 64;

struct JsonParse {
  JsonValue value;
  std::vector<ConfigIssue> issues;  ///< syntax (line, column), duplicate keys, numbers out of range, depth, size
  bool usable = false;              ///< false: no value at all (syntax); true may still have issues
};

/// Strict RFC 8259: no comments, no NaN or Infinity, no duplicate keys, valid UTF-8.
/// \param max_bytes larger texts are refused with an issue
JsonParse parse_json(std::string_view text, std::size_t max_bytes = kMaxConfigBytes);
}  // namespace venato
