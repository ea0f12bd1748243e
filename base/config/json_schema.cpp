#include <cmath>

#include "base/config/object_reader.h"
#include "base/config/reader_node.h"

namespace venato {
namespace {
using Object = JsonValue::Object;
using Array = JsonValue::Array;

Object schema_of(const ObjectDeclaration& object, bool closed);

Object number_schema(const KeyDeclaration& d, const char* type) {
  Object s{{"type", type}};
  if (std::isfinite(d.min)) s.emplace("minimum", d.min);
  if (std::isfinite(d.max)) s.emplace("maximum", d.max);
  return s;
}

Object list_schema(const KeyDeclaration& d, JsonValue items) {
  return {{"type", "array"},
          {"minItems", static_cast<std::uint64_t>(d.min_count)},
          {"maxItems", static_cast<std::uint64_t>(d.max_count)},
          {"items", std::move(items)}};
}

Object choice_schema(const KeyDeclaration& d) {
  Array names;
  for (const std::string& c : d.choices) names.emplace_back(c);
  return {{"type", "string"}, {"enum", std::move(names)}};
}

Object value_schema(const KeyDeclaration& d) {
  switch (d.kind) {
    case KeyKind::number:
      return number_schema(d, "number");
    case KeyKind::integer:
      return number_schema(d, "integer");
    case KeyKind::seed:
      return {{"type", "integer"}, {"minimum", 0}};
    case KeyKind::boolean:
      return {{"type", "boolean"}};
    case KeyKind::text:
    case KeyKind::path:
      return {{"type", "string"}};
    case KeyKind::name:
      return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]{1,40}$"}};
    case KeyKind::colour:
      return {{"type", "string"}, {"pattern", "^#[0-9A-Fa-f]{6}$"}};
    case KeyKind::numbers:
      return list_schema(d, number_schema(d, "number"));
    case KeyKind::tuples: {
      KeyDeclaration row = d;
      row.min_count = row.max_count = d.arity;
      return list_schema(d, list_schema(row, number_schema(d, "number")));
    }
    case KeyKind::choice:
    case KeyKind::pick:
      return choice_schema(d);
    case KeyKind::object:
      return schema_of(d.members, true);
    case KeyKind::objects:
      return list_schema(d, schema_of(d.members, true));
  }
  return {};
}

/// Help with the unit and the reason of the limits: what an editor shows on hover.
std::string hover_text(const KeyDeclaration& d) {
  std::string text = d.help;
  if (!d.unit.empty() && d.unit != "1") text += " [" + d.unit + "]";
  if (!d.why.empty()) text += " (limits: " + d.why + ")";
  if (d.placeholder) text += " PLACEHOLDER: no public source for this number";
  return text;
}

/// if key == name then the branch's keys, one per branch.
void add_branches(Object& schema, const KeyDeclaration& d) {
  Array rules;
  if (const auto it = schema.find("allOf"); it != schema.end()) rules = *it->second.array();
  for (const BranchDeclaration& b : d.branches) {
    Object equals{{"const", b.name}};
    Object when{{"properties", Object{{d.key, std::move(equals)}}}, {"required", Array{d.key}}};
    rules.emplace_back(Object{{"if", std::move(when)}, {"then", schema_of(b.keys, false)}});
  }
  schema.insert_or_assign("allOf", std::move(rules));
}

/// \param closed refuse unknown keys. "unevaluatedProperties" also sees the keys of the branches, which "additionalProperties" does not.
Object schema_of(const ObjectDeclaration& object, bool closed) {
  Object properties;
  Array required;
  Object schema;
  for (const KeyDeclaration& d : object.keys) {
    Object value = value_schema(d);
    if (const std::string text = hover_text(d); !text.empty()) value.emplace("description", text);
    if (d.fallback) value.emplace("default", *d.fallback);
    if (d.required) required.emplace_back(d.key);
    if (!d.branches.empty()) add_branches(schema, d);
    properties.emplace(d.key, std::move(value));
  }
  schema.emplace("properties", std::move(properties));
  if (!required.empty()) schema.emplace("required", std::move(required));
  if (closed) {
    schema.emplace("type", "object");
    schema.emplace("unevaluatedProperties", false);
  }
  return schema;
}
}  // namespace

std::string config_json_schema(const ReadRoot& root, std::string_view title) {
  Object schema = schema_of(declare_all(root), true);
  schema.emplace("$schema", "https://json-schema.org/draft/2020-12/schema");
  schema.emplace("title", title);
  schema.find("properties")->second.object()->emplace("$schema", Object{{"type", "string"}});
  return to_text(JsonValue(std::move(schema)), 2) + "\n";
}
}  // namespace venato
