#include "base/config/object_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/config/json_value.h"
#include "base/config/reader_node.h"
#include "base/config/suggest.h"
#include "base/expects.h"
#include "base/units.h"

// Keys with one plain value. Each function: declare -> take the file's value or the fallback -> check -> convert -> note it in the resolved config.
namespace venato {
namespace {
constexpr std::size_t kMaxTextLength = 4000;
constexpr std::size_t kMaxNameLength = 40;

template <class T>
KeyDeclaration declaration_of(std::string_view key, KeyKind kind, const Opt<T>& opt) {
  KeyDeclaration d;
  d.key = key;
  d.kind = kind;
  d.help = opt.help;
  if (opt.fallback) d.fallback = JsonValue(*opt.fallback);
  d.required = !opt.fallback.has_value() && !opt.optional;
  d.placeholder = opt.placeholder;
  return d;
}

void set_range(KeyDeclaration& d, const Range& range) {
  d.min = range.min;
  d.max = range.max;
  d.unit = range.unit;
  d.why = range.why;
  si_factor(range.unit);  // an unknown unit is found by describe-config, not by the first user of the key
}

/// Whole number, also when written 3.0; nullopt otherwise.
std::optional<std::int64_t> whole(const JsonValue& value) {
  if (const auto* i = std::get_if<std::int64_t>(&value.v)) return *i;
  if (const auto* u = std::get_if<std::uint64_t>(&value.v))
    return *u <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) ? std::optional(static_cast<std::int64_t>(*u)) : std::nullopt;
  if (const auto* d = std::get_if<double>(&value.v))
    if (std::abs(*d) < 1e15 && *d == std::floor(*d)) return static_cast<std::int64_t>(*d);
  return std::nullopt;
}

bool is_name(std::string_view text) {
  const auto ok = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-'; };
  return !text.empty() && text.size() <= kMaxNameLength && std::all_of(text.begin(), text.end(), ok);
}

std::optional<Rgb8> colour_of(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Rgb8 rgb{};
  for (std::size_t i = 0; i < 6; ++i) {
    const char c = text[i + 1];
    const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    if (digit < 0) return std::nullopt;
    rgb[i / 2] = static_cast<std::uint8_t>(rgb[i / 2] * 16 + digit);
  }
  return rgb;
}

/// The string value of `value`, or nullptr after a type issue.
const std::string* text_of(ObjectReader::Node& node, std::string_view key, const JsonValue& value) {
  if (!value.text()) {
    add_type_issue(node, pointer_join(node.pointer, key), "a string", value);
    return nullptr;
  }
  if (value.text()->size() > kMaxTextLength) {
    node.add_issue(key, "has " + std::to_string(value.text()->size()) + " bytes, the limit is " + std::to_string(kMaxTextLength));
    return nullptr;
  }
  if (value.text()->find('\0') != std::string::npos) {
    node.add_issue(key, "must not contain the character U+0000");
    return nullptr;
  }
  return value.text();
}
}  // namespace

void ObjectReader::number(std::string_view key, double& out, Range range, Opt<double> opt) {
  KeyDeclaration d = declaration_of(key, KeyKind::number, opt);
  set_range(d, range);
  VENATO_EXPECTS(!opt.fallback || (*opt.fallback >= range.min && *opt.fallback <= range.max));
  const JsonValue* value = node_.declare(std::move(d));
  if (!value || !read_number(node_, pointer_join(node_.pointer, key), *value, range, out)) return;
  node_.resolved.insert_or_assign(std::string(key), JsonValue(value->as_double()));
}

void ObjectReader::integer(std::string_view key, int& out, Range range, Opt<int> opt) {
  KeyDeclaration d = declaration_of(key, KeyKind::integer, opt);
  // An int must hold it even where the declaration names no limit.
  range.min = std::max(range.min, static_cast<double>(std::numeric_limits<int>::min()));
  range.max = std::min(range.max, static_cast<double>(std::numeric_limits<int>::max()));
  set_range(d, range);
  VENATO_EXPECTS(si_factor(range.unit) == 1);
  VENATO_EXPECTS(!opt.fallback || (*opt.fallback >= range.min && *opt.fallback <= range.max));
  const JsonValue* value = node_.declare(std::move(d));
  if (!value) return;
  const std::string where = pointer_join(node_.pointer, key);
  double checked = 0;
  if (!value->is_number()) {
    add_type_issue(node_, where, "a whole number", *value);
  } else if (read_number(node_, where, *value, range, checked)) {
    const auto n = whole(*value);
    if (!n) {
      node_.add_issue(key, "must be a whole number, is " + number_text(value->as_double()));
      return;
    }
    out = static_cast<int>(*n);
    node_.resolved.insert_or_assign(std::string(key), JsonValue(*n));
  }
}

void ObjectReader::seed(std::string_view key, std::uint64_t& out, Opt<std::uint64_t> opt) {
  const JsonValue* value = node_.declare(declaration_of(key, KeyKind::seed, opt));
  if (!value) return;
  const auto n = whole(*value);
  if (const auto* u = std::get_if<std::uint64_t>(&value->v)) {
    out = *u;
  } else if (n && *n >= 0) {
    out = static_cast<std::uint64_t>(*n);
  } else {
    const std::string wanted = "a whole number in [0, 18446744073709551615]";
    if (value->is_number())
      node_.add_issue(key, "must be " + wanted + ", is " + to_text(*value));
    else
      add_type_issue(node_, pointer_join(node_.pointer, key), wanted, *value);
    return;
  }
  node_.resolved.insert_or_assign(std::string(key), JsonValue(out));
}

void ObjectReader::boolean(std::string_view key, bool& out, Opt<bool> opt) {
  const JsonValue* value = node_.declare(declaration_of(key, KeyKind::boolean, opt));
  if (!value) return;
  const bool* given = std::get_if<bool>(&value->v);
  if (!given) {
    add_type_issue(node_, pointer_join(node_.pointer, key), "true or false", *value);
    return;
  }
  out = *given;
  node_.resolved.insert_or_assign(std::string(key), *value);
}

void ObjectReader::text(std::string_view key, std::string& out, Opt<std::string> opt) {
  const JsonValue* value = node_.declare(declaration_of(key, KeyKind::text, opt));
  const std::string* given = value ? text_of(node_, key, *value) : nullptr;
  if (!given) return;
  out = *given;
  node_.resolved.insert_or_assign(std::string(key), *value);
}

void ObjectReader::name(std::string_view key, std::string& out, Opt<std::string> opt) {
  VENATO_EXPECTS(!opt.fallback || is_name(*opt.fallback));
  const JsonValue* value = node_.declare(declaration_of(key, KeyKind::name, opt));
  const std::string* given = value ? text_of(node_, key, *value) : nullptr;
  if (!given) return;
  if (!is_name(*given)) {
    node_.add_issue(key, short_text(*value) + " is not a name: 1 to 40 of the characters A-Z a-z 0-9 _ - (it goes into file names)");
    return;
  }
  out = *given;
  node_.resolved.insert_or_assign(std::string(key), *value);
}

void ObjectReader::colour(std::string_view key, Rgb8& out, Opt<std::string> opt) {
  VENATO_EXPECTS(!opt.fallback || colour_of(*opt.fallback));
  const JsonValue* value = node_.declare(declaration_of(key, KeyKind::colour, opt));
  const std::string* given = value ? text_of(node_, key, *value) : nullptr;
  if (!given) return;
  const auto rgb = colour_of(*given);
  if (!rgb) {
    const bool only_hash_missing = colour_of("#" + *given).has_value();
    node_.add_issue(key, short_text(*value) + " is not a colour \"#rrggbb\"", only_hash_missing ? "did you mean \"#" + *given + "\"?" : "");
    return;
  }
  out = *rgb;
  node_.resolved.insert_or_assign(std::string(key), *value);
}

int ObjectReader::choice_index(std::string_view key, const std::vector<std::string_view>& names, const Opt<std::string>& opt) {
  VENATO_EXPECTS(!opt.fallback || std::find(names.begin(), names.end(), *opt.fallback) != names.end());
  KeyDeclaration d = declaration_of(key, KeyKind::choice, opt);
  d.choices.assign(names.begin(), names.end());
  const std::vector<std::string> choices = d.choices;
  const JsonValue* value = node_.declare(std::move(d));
  const std::string* given = value ? text_of(node_, key, *value) : nullptr;
  if (!given) return -1;
  const auto it = std::find(names.begin(), names.end(), *given);
  if (it == names.end()) {
    std::string list;
    for (const std::string& c : choices) list += (list.empty() ? "" : ", ") + c;
    const std::string meant = nearest(*given, choices);
    node_.add_issue(key, "'" + short_text(JsonValue(*given)).substr(1, given->size()) + "' is not one of: " + list,
                    meant.empty() ? "" : "did you mean '" + meant + "'?");
    return -1;
  }
  node_.resolved.insert_or_assign(std::string(key), *value);
  return static_cast<int>(it - names.begin());
}
}  // namespace venato
