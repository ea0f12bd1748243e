#include "base/config/reader_node.h"

#include <algorithm>
#include <cmath>

#include "base/config/json_parse.h"
#include "base/config/suggest.h"
#include "base/expects.h"
#include "base/units.h"

namespace venato {

const JsonValue* ObjectReader::Node::find(std::string_view key) const {
  if (!given) return nullptr;
  const auto it = given->find(key);
  return it == given->end() ? nullptr : &it->second;
}

void ObjectReader::Node::add_issue(std::string_view key, std::string problem, std::string suggestion) {
  add_issue_at(key.empty() ? pointer : pointer_join(pointer, key), std::move(problem), std::move(suggestion));
}

void ObjectReader::Node::add_issue_at(std::string where, std::string problem, std::string suggestion) {
  if (!describing()) state->issues.push_back({std::move(where), std::move(problem), std::move(suggestion)});
}

const JsonValue* ObjectReader::Node::declare(KeyDeclaration key) {
  if (describing()) {
    const bool known = std::any_of(declaration->keys.begin(), declaration->keys.end(), [&](const KeyDeclaration& k) { return k.key == key.key; });
    if (!known) declaration->keys.push_back(std::move(key));
    return nullptr;
  }
  asked.push_back(key.key);
  if (!key.unit.empty()) unit_of.emplace(key.key, key.unit);
  const JsonValue* value = find(key.key);
  if (!value) {
    if (!key.fallback) {
      if (key.required) add_issue(key.key, "is missing (no hidden defaults)");
      return nullptr;
    }
    value = &fallbacks.insert_or_assign(key.key, *key.fallback).first->second;
  }
  if (key.placeholder) use_placeholder(key, *value);
  return value;
}

void ObjectReader::Node::use_placeholder(const KeyDeclaration& key, const JsonValue& value) {
  // A user's own number in place of ours is not a placeholder any more.
  const bool own_number = key.fallback && short_text(value) != short_text(*key.fallback);
  if (!own_number) state->placeholders.push_back({pointer_join(pointer, key.key), short_text(value), key.unit, key.help});
}

void ObjectReader::Node::report_unknown_keys() {
  if (!given || silent_about_unknown) return;
  std::vector<std::string> missing, present;
  for (const std::string& key : asked) (given->contains(key) ? present : missing).push_back(key);
  for (const auto& [key, value] : *given) {
    if (std::find(asked.begin(), asked.end(), key) != asked.end()) continue;
    std::string meant = nearest(key, missing);  // a key that the file lacks is the likelier one
    if (meant.empty()) meant = nearest(key, present);
    std::string suggestion;
    if (!meant.empty()) {
      suggestion = "did you mean '" + meant + "'?";
      if (const auto unit = unit_of.find(meant); unit != unit_of.end() && unit->second != "1") suggestion += " (in " + unit->second + ")";
    } else if (asked.empty()) {
      suggestion = "this object has no keys";
    } else if (asked.size() <= 12) {
      suggestion = "known keys:";
      for (const std::string& k : asked) suggestion += (k == asked.front() ? " " : ", ") + k;
    }
    add_issue(key, "is not a known key", suggestion);
  }
}

void add_type_issue(ObjectReader::Node& node, std::string where, std::string_view wanted, const JsonValue& value) {
  std::string problem = "must be " + std::string(wanted) + ", is ";
  const bool bracketed = value.array() || value.object();
  problem += std::string(value.type_name());
  if (!bracketed && value.v.index() != 0) problem += " " + short_text(value);
  std::string suggestion;
  if (const std::string* text = value.text(); text && wanted != "a string") {
    // "0.5" or "true" in quotes: say what the value would be without them, when that is of the wanted kind.
    const JsonParse inner = parse_json(*text);
    const bool numeric = wanted.find("number") != std::string_view::npos || wanted.find("seed") != std::string_view::npos;
    const bool fits =
        inner.usable && ((numeric && inner.value.is_number()) || (wanted == "true or false" && std::holds_alternative<bool>(inner.value.v)));
    if (fits) suggestion = "did you mean " + to_text(inner.value) + "?";
  }
  if (wanted == "true or false" && value.is_number() && (value.as_double() == 0 || value.as_double() == 1))
    suggestion = value.as_double() == 1 ? "did you mean true?" : "did you mean false?";
  node.add_issue_at(std::move(where), std::move(problem), std::move(suggestion));
}

std::string range_text(const Range& range) {
  const auto end = [](double v) { return std::isinf(v) ? (v > 0 ? std::string("inf") : std::string("-inf")) : number_text(v); };
  std::string text = std::isinf(range.min) ? "(" : "[";
  text += end(range.min) + ", " + end(range.max) + (std::isinf(range.max) ? ")" : "]");
  if (!range.unit.empty() && range.unit != "1") text += " " + std::string(range.unit);
  if (!range.why.empty()) text += " (" + std::string(range.why) + ")";
  return text;
}

bool read_number(ObjectReader::Node& node, const std::string& where, const JsonValue& value, const Range& range, double& si) {
  if (!value.is_number()) {
    add_type_issue(node, where, "a number", value);
    return false;
  }
  const double v = value.as_double();
  if (!(v >= range.min && v <= range.max)) {
    node.add_issue_at(where, number_text(v) + " is outside " + range_text(range));
    return false;
  }
  si = v * si_factor(range.unit);
  return true;
}
}  // namespace venato
