#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/config/json_value.h"
#include "base/config/object_reader.h"
namespace venato {

struct KeyDeclaration;
/// All keys that one object may have, in the order of their declaration: filled in describe mode.
struct ObjectDeclaration {
  std::vector<KeyDeclaration> keys;
};

enum class KeyKind { number, integer, seed, boolean, text, name, colour, path, numbers, tuples, choice, object, objects, pick };

struct BranchDeclaration {
  std::string name, help;
  ObjectDeclaration keys;
};

/// One declaration, as the reference table and the JSON Schema need it.
struct KeyDeclaration {
  std::string key;
  KeyKind kind = KeyKind::number;
  std::string help;
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  std::string unit, why;
  std::optional<JsonValue> fallback;
  bool required = true;
  bool placeholder = false;
  std::size_t arity = 0, min_count = 0, max_count = 0;
  std::vector<std::string> choices;
  ObjectDeclaration members;                ///< object, objects
  std::vector<BranchDeclaration> branches;  ///< pick
};

/// What all nodes of one reading share.
struct ReadState {
  std::filesystem::path base_folder;
  std::vector<ConfigIssue> issues;
  std::vector<PlaceholderUse> placeholders;
};

/// One JSON object while it is being read (or declared).
struct ObjectReader::Node {
  ReadState* state = nullptr;
  std::string pointer;
  const JsonValue::Object* given = nullptr;  ///< nullptr: nothing in the file (fallbacks apply) or describe mode
  ObjectDeclaration* declaration = nullptr;  ///< describe mode only
  JsonValue::Object resolved;
  std::vector<std::string> asked;  ///< keys, in order of declaration
  std::map<std::string, std::string, std::less<>> unit_of;
  bool silent_about_unknown = false;  ///< after a failed pick() the other keys cannot be judged

  bool describing() const { return declaration != nullptr; }
  const JsonValue* find(std::string_view key) const;
  void add_issue(std::string_view key, std::string problem, std::string suggestion = {});
  void add_issue_at(std::string where, std::string problem, std::string suggestion = {});
  /// Describe mode: stores the declaration and returns nullptr. Else returns the value to read; when the key is absent it resolves to
  /// the fallback (returned) or is reported as missing (nullptr).
  const JsonValue* declare(KeyDeclaration key);
  void use_placeholder(const KeyDeclaration& key, const JsonValue& value);
  void report_unknown_keys();

  std::map<std::string, JsonValue> fallbacks;  ///< keeps returned fallbacks alive
};

/// `must be a number, is string "0.5"` + "did you mean 0.5?"
void add_type_issue(ObjectReader::Node& node, std::string where, std::string_view wanted, const JsonValue& value);
/// Reads, checks and converts one number; false after an issue.
bool read_number(ObjectReader::Node& node, const std::string& where, const JsonValue& value, const Range& range, double& si);
std::string range_text(const Range& range);  ///< "[5, 60] MPa (press rating)"

ObjectDeclaration declare_all(const ReadRoot& root);
}  // namespace venato
