#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/config/json_parse.h"

namespace venato {
namespace {

struct Place {
  std::size_t line = 1, column = 1;
};

Place place_of(std::string_view text, std::size_t byte) {
  Place place;
  for (std::size_t i = 0; i < std::min(byte, text.size()); ++i) {
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) {  // columns count characters, not bytes
      ++place.column;
    }
  }
  return place;
}

std::string said(Place place) { return "line " + std::to_string(place.line) + ", column " + std::to_string(place.column); }

/// The word (letters, digits, sign, dot) around `byte`: what the user typed where JSON wants a value.
std::string_view word_at(std::string_view text, std::size_t byte) {
  const auto in_word = [&](std::size_t i) {
    const char c = text[i];
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '+' || c == '-' || c == '.' || c == '_';
  };
  if (text.empty()) return {};
  std::size_t begin = std::min(byte, text.size() - 1), end = begin;
  if (!in_word(begin) && begin > 0) begin = end = begin - 1;
  while (begin > 0 && in_word(begin - 1)) --begin;
  while (end < text.size() && in_word(end)) ++end;
  return end > begin && in_word(begin) ? text.substr(begin, end - begin) : std::string_view{};
}

bool is_non_finite_word(std::string_view word) {
  std::string lower;
  for (const char c : word)
    if (c != '+' && c != '-') lower += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

/// nlohmann's text is "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while … - reason": keep the reason.
std::string reason_of(const std::string& what) {
  std::string reason = what;
  if (const auto colon = reason.find("column "); colon != std::string::npos)
    if (const auto after = reason.find(": ", colon); after != std::string::npos) reason = reason.substr(after + 2);
  return reason;
}

/// Builds a JsonValue and collects what is wrong. The stack of open containers gives each problem its pointer.
class Builder {
 public:
  explicit Builder(std::string_view text) : text_(text) {}
  bool null() { return value({}); }
  bool boolean(bool b) { return value(b); }
  bool number_integer(std::int64_t i) { return value(i); }
  bool number_unsigned(std::uint64_t u) { return value(u); }
  bool number_float(double d, const std::string&) { return value(d); }
  bool string(std::string& s) { return value(std::move(s)); }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool key(std::string& k) {
    Open& top = open_.back();
    top.key = k;
    if (top.value.object()->contains(k)) add(pointer(), "is given twice", "keep one of the two");
    return true;
  }
  bool start_object(std::size_t) { return start(JsonValue::Object{}); }
  bool start_array(std::size_t) { return start(JsonValue::Array{}); }
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  bool parse_error(std::size_t byte, const std::string& token, const nlohmann::json::exception& error) {
    constexpr int kNumberOverflow = 406;
    const std::size_t at = byte > 0 ? byte - 1 : 0;
    const std::string_view word = word_at(text_, at);
    const std::string where = said(place_of(text_, at));
    if (error.id == kNumberOverflow)
      add(pointer(), where + ": " + token + " is beyond the range of numbers (1.8e308)", "give a finite number");
    else if (is_non_finite_word(word))
      add(pointer(), where + ": " + std::string(word) + " is not a JSON number", "give a finite number");
    else
      add("", where + ": " + reason_of(error.what()));
    return false;
  }

  JsonParse result() && { return {std::move(root_), std::move(issues_), false}; }

 private:
  struct Open {
    JsonValue value;
    std::string key;
  };

  std::string pointer() const {
    std::string p;
    for (const Open& o : open_) p = pointer_join(p, o.value.object() ? o.key : std::to_string(o.value.array()->size()));
    return p;
  }
  void add(std::string where, std::string problem, std::string suggestion = {}) {
    issues_.push_back({std::move(where), std::move(problem), std::move(suggestion)});
  }
  bool start(JsonValue container) {
    if (static_cast<int>(open_.size()) >= kMaxJsonDepth) {
      add("", "is nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
      return false;
    }
    open_.push_back({std::move(container), {}});
    return true;
  }
  bool end() {
    JsonValue done = std::move(open_.back().value);
    open_.pop_back();
    return value(std::move(done));
  }
  bool value(JsonValue v) {
    if (open_.empty())
      root_ = std::move(v);
    else if (auto* a = open_.back().value.array())
      a->push_back(std::move(v));
    else
      open_.back().value.object()->emplace(open_.back().key, std::move(v));  // of a repeated key the first stays
    return true;
  }

  std::string_view text_;
  std::vector<Open> open_;
  JsonValue root_;
  std::vector<ConfigIssue> issues_;
};
}  // namespace

JsonParse parse_json(std::string_view text, std::size_t max_bytes) {
  if (text.size() > max_bytes) {
    JsonParse refused;
    refused.issues.push_back({"", "has " + std::to_string(text.size()) + " bytes, the limit is " + std::to_string(max_bytes) + " bytes", ""});
    return refused;
  }
  Builder builder(text);
  const bool complete = nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  JsonParse parse = std::move(builder).result();
  parse.usable = complete;
  return parse;
}
}  // namespace venato
