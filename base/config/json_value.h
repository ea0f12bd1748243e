#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>
namespace venato {

/// A JSON value of ours: keys sorted, whole numbers kept apart from others, text form canonical. The reader works on it so that
/// the JSON library stays in one file (json_parse_json.cpp).
struct JsonValue {
  using Array = std::vector<JsonValue>;
  using Object = std::map<std::string, JsonValue, std::less<>>;
  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object> v = nullptr;

  JsonValue() = default;
  JsonValue(bool b) : v(b) {}
  JsonValue(int i) : v(static_cast<std::int64_t>(i)) {}
  JsonValue(std::int64_t i) : v(i) {}
  JsonValue(std::uint64_t i) : v(i) {}
  JsonValue(double d) : v(d) {}
  JsonValue(const char* s) : v(std::string(s)) {}  // without it a literal would become a bool
  JsonValue(std::string s) : v(std::move(s)) {}
  JsonValue(std::string_view s) : v(std::string(s)) {}
  JsonValue(Array a) : v(std::move(a)) {}
  JsonValue(Object o) : v(std::move(o)) {}

  bool is_number() const { return v.index() >= 2 && v.index() <= 4; }
  double as_double() const;  ///< is_number() only
  const std::string* text() const { return std::get_if<std::string>(&v); }
  const Array* array() const { return std::get_if<Array>(&v); }
  Array* array() { return std::get_if<Array>(&v); }
  const Object* object() const { return std::get_if<Object>(&v); }
  Object* object() { return std::get_if<Object>(&v); }
  std::string_view type_name() const;  ///< "null", "boolean", "number", "string", "array", "object"
};

/// Canonical text: sorted keys, shortest digits that read back to the same double (1, 1.0 and 1e0 are the same text), no white space
/// when indent is 0, else pretty with that many blanks per level. Non-finite numbers are a programmer error.
std::string to_text(const JsonValue& value, int indent = 0);
std::string json_quoted(std::string_view text);  ///< with quotes and escapes
std::string number_text(double value);           ///< shortest round trip; whole numbers below 1e15 without exponent; inf, -inf, nan as such

/// Shortened for messages: at most ~60 characters.
std::string short_text(const JsonValue& value);

/// Tokens of a JSON pointer ("/a/b~1c" -> a, b/c). \throws std::invalid_argument when not empty and not beginning with '/'.
std::vector<std::string> pointer_tokens(std::string_view pointer);
std::string pointer_join(std::string_view parent, std::string_view token);
/// nullptr when there is nothing at that pointer.
const JsonValue* find_pointer(const JsonValue& root, std::string_view pointer);
}  // namespace venato
