#include <charconv>
#include <stdexcept>

#include "base/config/json_parse.h"
#include "base/config/object_reader.h"
#include "base/config/reader_node.h"
#include "base/io/atomic_file.h"

// Entry points: text -> JSON value -> overrides -> strict reading -> outcome.
namespace venato {
namespace {

/// Sets `pointer` in `root`, making objects on the way; returns what is wrong, "" if nothing.
std::string set_at(JsonValue& root, const std::string& pointer, JsonValue value) {
  JsonValue* at = &root;
  for (const std::string& token : pointer_tokens(pointer)) {
    if (JsonValue::Array* list = at->array()) {
      std::size_t index = 0;
      const auto end = std::from_chars(token.data(), token.data() + token.size(), index);
      if (end.ec != std::errc() || end.ptr != token.data() + token.size() || index >= list->size())
        return "--set: '" + token + "' is not an index of a list with " + std::to_string(list->size()) + " items";
      at = &(*list)[index];
    } else if (JsonValue::Object* object = at->object()) {
      JsonValue& member = (*object)[token];
      if (member.v.index() == 0) member = JsonValue(JsonValue::Object{});
      at = &member;
    } else {
      return "--set: cannot go below a " + std::string(at->type_name());
    }
  }
  *at = std::move(value);
  return "";
}

void apply(const Override& change, JsonValue& root, std::vector<ConfigIssue>& issues) {
  const JsonParse parsed = parse_json(change.value);
  JsonValue value = parsed.usable && parsed.issues.empty() ? parsed.value : JsonValue(change.value);
  std::string problem = set_at(root, change.pointer, std::move(value));
  if (!problem.empty()) issues.push_back({change.pointer, std::move(problem), ""});
}

JsonValue::Object read_root(ReadState& state, const JsonValue::Object& given, const ReadRoot& root) {
  ObjectReader::Node node;
  node.state = &state;
  node.given = &given;
  ObjectReader reader(node);
  root(reader);
  node.report_unknown_keys();
  return std::move(node.resolved);
}
}  // namespace

Override parse_override(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || text.empty() || text.front() != '/' || equals < 2)
    throw UsageError("--set " + std::string(text) + ": must be /json/pointer=value, e.g. /chain/3/peak_pressure_mpa=35");
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

ReadOutcome read_config_text(std::string_view json, const std::filesystem::path& base_folder, const std::vector<Override>& overrides,
                             const ReadRoot& root) {
  ReadOutcome outcome;
  outcome.file = "config";
  JsonParse parsed = parse_json(json);
  outcome.issues = std::move(parsed.issues);
  if (!parsed.usable) return outcome;
  if (!parsed.value.object()) {
    outcome.issues.push_back({"", "must hold an object { … }, is " + std::string(parsed.value.type_name()), ""});
    return outcome;
  }
  for (const Override& change : overrides) apply(change, parsed.value, outcome.issues);
  parsed.value.object()->erase("$schema");  // lets editors find the schema; means nothing to us
  ReadState state;
  state.base_folder = base_folder;
  const JsonValue resolved(read_root(state, *parsed.value.object(), root));
  outcome.issues.insert(outcome.issues.end(), state.issues.begin(), state.issues.end());
  outcome.resolved_json = to_text(resolved);
  outcome.placeholders = std::move(state.placeholders);
  return outcome;
}

ReadOutcome read_config_file(const std::filesystem::path& file, const std::vector<Override>& overrides, const ReadRoot& root) {
  const std::string text = read_file(file, kMaxConfigBytes);
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  ReadOutcome outcome = read_config_text(text, folder, overrides, root);
  outcome.file = file.string();
  return outcome;
}

std::string ReadOutcome::subtree(std::string_view pointer) const {
  const JsonParse parsed = parse_json(resolved_json, resolved_json.size());
  const JsonValue* part = parsed.usable ? find_pointer(parsed.value, pointer) : nullptr;
  if (!part) throw std::logic_error("ReadOutcome::subtree: the resolved config has nothing at '" + std::string(pointer) + "'");
  return to_text(*part);
}

void ReadOutcome::throw_if_bad() const {
  if (!ok()) throw ConfigError(file, issues);
}

ObjectDeclaration declare_all(const ReadRoot& root) {
  ObjectDeclaration all;
  ReadState state;
  ObjectReader::Node node;
  node.state = &state;
  node.declaration = &all;
  ObjectReader reader(node);
  root(reader);
  return all;
}
}  // namespace venato
