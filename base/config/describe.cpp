#include <cmath>

#include "base/config/object_reader.h"
#include "base/config/reader_node.h"

// describe-config: the reference table and the JSON Schema, both from the declarations that read the file.
namespace venato {
namespace {

std::string_view kind_name(KeyKind kind) {
  switch (kind) {
    case KeyKind::number:
      return "number";
    case KeyKind::integer:
      return "whole number";
    case KeyKind::seed:
      return "whole number in [0, 2^64)";
    case KeyKind::boolean:
      return "true or false";
    case KeyKind::text:
      return "string";
    case KeyKind::name:
      return "name";
    case KeyKind::colour:
      return "colour \"#rrggbb\"";
    case KeyKind::path:
      return "path";
    case KeyKind::numbers:
      return "list of numbers";
    case KeyKind::tuples:
      return "list of tuples";
    case KeyKind::choice:
    case KeyKind::pick:
      return "one of";
    case KeyKind::object:
      return "object";
    case KeyKind::objects:
      return "list of objects";
  }
  return "";
}

bool is_list(KeyKind kind) { return kind == KeyKind::numbers || kind == KeyKind::tuples || kind == KeyKind::objects; }
bool has_range(const KeyDeclaration& d) { return std::isfinite(d.min) || std::isfinite(d.max) || (!d.unit.empty() && d.unit != "1"); }

std::string type_text(const KeyDeclaration& d) {
  std::string text(kind_name(d.kind));
  if (d.kind == KeyKind::tuples) text = "list of [" + std::to_string(d.arity) + " numbers]";
  if (!d.choices.empty()) {
    text += ":";
    for (const std::string& c : d.choices) text += (c == d.choices.front() ? " " : ", ") + c;
  }
  if (is_list(d.kind)) text += ", " + std::to_string(d.min_count) + " to " + std::to_string(d.max_count) + " items";
  if (d.kind != KeyKind::integer || std::abs(d.max) < 2147483647. || d.min > -2147483648.)
    if (has_range(d)) text += " in " + range_text({d.min, d.max, d.unit, d.why});
  return text;
}

void add_line(std::string& out, const std::string& pointer, const KeyDeclaration& d) {
  out += pointer + "\n    " + type_text(d);
  if (d.fallback)
    out += "; default " + short_text(*d.fallback);
  else
    out += d.required ? "; required" : "; optional";
  if (d.placeholder) out += "; PLACEHOLDER (no public source for this number)";
  out += "\n";
  if (!d.help.empty()) out += "    " + d.help + "\n";
}

void describe(std::string& out, const std::string& pointer, const ObjectDeclaration& object) {
  for (const KeyDeclaration& d : object.keys) {
    const std::string at = pointer_join(pointer, d.key);
    add_line(out, at, d);
    describe(out, d.kind == KeyKind::objects ? at + "/N" : at, d.members);
    for (const BranchDeclaration& b : d.branches) {
      out += at + " = \"" + b.name + "\"\n";
      if (!b.help.empty()) out += "    " + b.help + "\n";
      describe(out, pointer, b.keys);
    }
  }
}
}  // namespace

std::string describe_config_text(const ReadRoot& root) {
  std::string out;
  describe(out, "", declare_all(root));
  return out;
}
}  // namespace venato
