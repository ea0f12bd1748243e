#include "base/config/json_value.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "base/expects.h"

namespace venato {
namespace {
constexpr std::size_t kShortTextLength = 60;

void newline(std::string& out, int indent, int level) {
  if (indent == 0) return;
  out += '\n';
  out.append(static_cast<std::size_t>(indent * level), ' ');
}

void append(std::string& out, const JsonValue& value, int indent, int level);

template <class Items, class Each>
void append_items(std::string& out, const Items& items, const char* brackets, int indent, int level, Each each) {
  out += brackets[0];
  bool first = true;
  for (const auto& item : items) {
    if (!first) out += ',';
    first = false;
    newline(out, indent, level + 1);
    each(item);
  }
  if (!first) newline(out, indent, level);
  out += brackets[1];
}

void append(std::string& out, const JsonValue& value, int indent, int level) {
  if (const auto* o = value.object()) {
    append_items(out, *o, "{}", indent, level, [&](const auto& item) {
      out += json_quoted(item.first);
      out += indent ? ": " : ":";
      append(out, item.second, indent, level + 1);
    });
  } else if (const auto* a = value.array()) {
    append_items(out, *a, "[]", indent, level, [&](const JsonValue& item) { append(out, item, indent, level + 1); });
  } else if (const auto* s = value.text()) {
    out += json_quoted(*s);
  } else if (const auto* b = std::get_if<bool>(&value.v)) {
    out += *b ? "true" : "false";
  } else if (const auto* i = std::get_if<std::int64_t>(&value.v)) {
    out += std::to_string(*i);
  } else if (const auto* u = std::get_if<std::uint64_t>(&value.v)) {
    out += std::to_string(*u);
  } else if (const auto* d = std::get_if<double>(&value.v)) {
    VENATO_EXPECTS(std::isfinite(*d));
    out += number_text(*d);
  } else {
    out += "null";
  }
}
}  // namespace

double JsonValue::as_double() const {
  if (const auto* d = std::get_if<double>(&v)) return *d;
  if (const auto* i = std::get_if<std::int64_t>(&v)) return static_cast<double>(*i);
  VENATO_EXPECTS(std::holds_alternative<std::uint64_t>(v));
  return static_cast<double>(std::get<std::uint64_t>(v));
}

std::string_view JsonValue::type_name() const {
  constexpr std::array<std::string_view, 8> kNames = {"null", "boolean", "number", "number", "number", "string", "array", "object"};
  return kNames[v.index()];
}

std::string to_text(const JsonValue& value, int indent) {
  std::string out;
  append(out, value, indent, 0);
  return out;
}

std::string json_quoted(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else if (code < 0x20) {
      out += "\\u00";
      out += kHex[code >> 4];
      out += kHex[code & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string number_text(double value) {
  if (value == 0) return "0";  // also -0: the sign of zero must not change a hash
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  std::array<char, 40> digits;
  const bool plain = std::abs(value) < 1e15 && (std::abs(value) >= 1e-4);
  const auto end = plain ? std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed)
                         : std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end.ptr};
}

std::string short_text(const JsonValue& value) {
  std::string text = to_text(value);
  if (text.size() <= kShortTextLength) return text;
  std::size_t cut = kShortTextLength - 3;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) --cut;  // not inside a UTF-8 character
  return text.substr(0, cut) + "...";
}

std::vector<std::string> pointer_tokens(std::string_view pointer) {
  std::vector<std::string> tokens;
  if (pointer.empty()) return tokens;
  if (pointer.front() != '/') throw std::invalid_argument("a JSON pointer begins with '/'");
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~' && i + 1 < pointer.size() && (pointer[i + 1] == '0' || pointer[i + 1] == '1')) {
      tokens.back() += pointer[++i] == '0' ? '~' : '/';
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

std::string pointer_join(std::string_view parent, std::string_view token) {
  std::string out(parent);
  out += '/';
  for (const char c : token) {
    if (c == '~' || c == '/')
      out += c == '~' ? "~0" : "~1";
    else
      out += c;
  }
  return out;
}

const JsonValue* find_pointer(const JsonValue& root, std::string_view pointer) {
  const JsonValue* at = &root;
  for (const std::string& token : pointer_tokens(pointer)) {
    if (const auto* o = at->object()) {
      const auto it = o->find(token);
      if (it == o->end()) return nullptr;
      at = &it->second;
    } else if (const auto* a = at->array()) {
      std::size_t index = 0;
      const auto end = std::from_chars(token.data(), token.data() + token.size(), index);
      if (end.ec != std::errc() || end.ptr != token.data() + token.size() || index >= a->size()) return nullptr;
      at = &(*a)[index];
    } else {
      return nullptr;
    }
  }
  return at;
}
}  // namespace venato
