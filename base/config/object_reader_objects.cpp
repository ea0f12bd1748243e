#include <algorithm>

#include "base/config/object_reader.h"
#include "base/config/reader_node.h"
#include "base/config/suggest.h"
#include "base/expects.h"

// Nested objects, lists of objects, unions; and what a cross-field check may ask.
namespace venato {
namespace {

KeyDeclaration object_declaration(std::string_view key, KeyKind kind, std::string_view help, bool required) {
  KeyDeclaration d;
  d.key = key;
  d.kind = kind;
  d.help = help;
  d.required = required;
  return d;
}

/// Reads one nested object and returns its resolved form.
JsonValue::Object read_nested(ObjectReader::Node& parent, std::string where, const JsonValue::Object* given,
                              const std::function<void(ObjectReader&)>& read) {
  ObjectReader::Node node;
  node.state = parent.state;
  node.pointer = std::move(where);
  node.given = given;
  ObjectReader reader(node);
  read(reader);
  node.report_unknown_keys();
  return std::move(node.resolved);
}

/// In describe mode: visits the members once so that they are declared.
void declare_nested(ObjectReader::Node& parent, KeyDeclaration d, const std::function<void(ObjectReader&)>& read) {
  ObjectReader::Node node;
  node.state = parent.state;
  node.pointer = pointer_join(parent.pointer, d.key);
  node.declaration = &d.members;
  ObjectReader reader(node);
  read(reader);
  parent.declare(std::move(d));
}
}  // namespace

bool ObjectReader::object(std::string_view key, std::string_view help, const std::function<void(ObjectReader&)>& read, bool required) {
  KeyDeclaration d = object_declaration(key, KeyKind::object, help, required);
  if (describing()) {
    declare_nested(node_, std::move(d), read);
    return false;
  }
  const JsonValue* value = node_.declare(std::move(d));
  const std::string where = pointer_join(node_.pointer, key);
  if (value && !value->object()) {
    add_type_issue(node_, where, "an object", *value);
    return true;
  }
  if (!value && required) return false;  // one "is missing" for the object, not one for each of its keys
  node_.resolved.insert_or_assign(std::string(key), JsonValue(read_nested(node_, where, value ? value->object() : nullptr, read)));
  return value != nullptr;
}

bool ObjectReader::optional_object(std::string_view key, std::string_view help, const std::function<void(ObjectReader&)>& read) {
  KeyDeclaration d = object_declaration(key, KeyKind::object, help, false);
  if (describing()) {
    declare_nested(node_, std::move(d), read);
    return true;
  }
  const JsonValue* value = node_.declare(std::move(d));
  if (!value) return false;
  const std::string where = pointer_join(node_.pointer, key);
  if (!value->object())
    add_type_issue(node_, where, "an object", *value);
  else
    node_.resolved.insert_or_assign(std::string(key), JsonValue(read_nested(node_, where, value->object(), read)));
  return true;
}

void ObjectReader::objects(std::string_view key, std::string_view help, std::size_t min_count, std::size_t max_count,
                           const std::function<void(ObjectReader&, std::size_t)>& read) {
  KeyDeclaration d = object_declaration(key, KeyKind::objects, help, min_count > 0);
  d.min_count = min_count;
  d.max_count = max_count;
  if (min_count == 0) d.fallback = JsonValue(JsonValue::Array{});
  if (describing()) {
    declare_nested(node_, std::move(d), [&](ObjectReader& r) { read(r, 0); });
    return;
  }
  const JsonValue* value = node_.declare(std::move(d));
  if (!value) return;
  const std::string where = pointer_join(node_.pointer, key);
  const JsonValue::Array* list = value->array();
  if (!list) {
    add_type_issue(node_, where, "a list of objects", *value);
    return;
  }
  if (list->size() < min_count || list->size() > max_count)
    node_.add_issue(key,
                    "must have " + std::to_string(min_count) + " to " + std::to_string(max_count) + " items, has " + std::to_string(list->size()));
  JsonValue::Array resolved;
  // Items beyond max_count are not read: one issue for the list is enough and a huge list stays cheap.
  for (std::size_t i = 0; i < std::min(list->size(), max_count); ++i) {
    const std::string at = pointer_join(where, std::to_string(i));
    const JsonValue::Object* item = (*list)[i].object();
    if (!item) {
      add_type_issue(node_, at, "an object", (*list)[i]);
      continue;
    }
    resolved.emplace_back(read_nested(node_, at, item, [&](ObjectReader& r) { read(r, i); }));
  }
  node_.resolved.insert_or_assign(std::string(key), JsonValue(std::move(resolved)));
}

void ObjectReader::pick(std::string_view key, std::string_view help, const std::vector<Branch>& branches) {
  VENATO_EXPECTS(!branches.empty());
  KeyDeclaration d = object_declaration(key, KeyKind::pick, help, true);
  std::vector<std::string_view> names;
  for (const Branch& branch : branches) {
    names.push_back(branch.name);
    d.choices.push_back(branch.name);
    if (!describing()) continue;
    BranchDeclaration declared{branch.name, branch.help, {}};
    Node node;
    node.state = node_.state;
    node.pointer = node_.pointer;
    node.declaration = &declared.keys;
    ObjectReader reader(node);
    branch.read(reader);
    d.branches.push_back(std::move(declared));
  }
  if (describing()) {
    node_.declare(std::move(d));
    return;
  }
  const int k = choice_index(key, names, {help, std::nullopt, false});
  if (k < 0)
    node_.silent_about_unknown = true;
  else
    branches[static_cast<std::size_t>(k)].read(*this);
}

void ObjectReader::issue(std::string_view key, std::string problem, std::string suggestion) {
  node_.add_issue(key, std::move(problem), std::move(suggestion));
}

bool ObjectReader::describing() const { return node_.describing(); }
bool ObjectReader::has(std::string_view key) const { return node_.find(key) != nullptr; }
std::string ObjectReader::pointer() const { return node_.pointer; }
}  // namespace venato
