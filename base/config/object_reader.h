#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "base/error.h"
namespace venato {

/// Allowed values in the key's own unit, both ends included; the reader multiplies by si_factor(unit) once.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string_view unit = "";
  std::string_view why = "";  ///< shown in the message, e.g. "press rating"
};

/// The rest of one declaration. A key without fallback is required, unless it is `optional`: absent, `out` keeps its value. Fallbacks are in the
/// key's own unit.
template <class T>
struct Opt {
  std::string_view help = "";
  std::optional<T> fallback = std::nullopt;
  bool placeholder = false;  ///< no public source for this number: marked in the reference and in the report
  bool optional = false;     ///< for keys that are needed only beside others
};

enum class PathKind { existing_file, any };
using Rgb8 = std::array<std::uint8_t, 3>;

/// Strict reader of one JSON object: each call declares one key (name, member, range, unit, help), reads and converts it to SI, and is
/// also what describe-config and the JSON Schema are made from. Problems are collected, never thrown: reading goes on so that
/// a user sees all mistakes at once. Keys of the file that nobody asked for are issues with "did you mean".
/// NaN, infinities, numbers in quotes, integers given as 1.5 … are issues. Members keep their value when their key has an issue.
///
/// In describe mode (describing() == true) there is no file: every branch of pick() and one element of objects() are visited.
class ObjectReader {
 public:
  void number(std::string_view key, double& out, Range range, Opt<double> opt = {});
  void integer(std::string_view key, int& out, Range range, Opt<int> opt = {});
  void seed(std::string_view key, std::uint64_t& out, Opt<std::uint64_t> opt = {});
  void boolean(std::string_view key, bool& out, Opt<bool> opt = {});
  void text(std::string_view key, std::string& out, Opt<std::string> opt = {});
  void name(std::string_view key, std::string& out, Opt<std::string> opt = {});  ///< [A-Za-z0-9_-]{1,40}: goes into file names
  void colour(std::string_view key, Rgb8& out, Opt<std::string> opt = {});       ///< "#rrggbb" (sRGB)
  /// Relative paths are relative to the config file's folder. existing_file: must be a readable regular file.
  /// An empty-string fallback means "none": out stays empty.
  void path(std::string_view key, std::filesystem::path& out, PathKind kind, Opt<std::string> opt = {});
  void numbers(std::string_view key, std::vector<double>& out, Range each, std::size_t min_count, std::size_t max_count,
               Opt<std::vector<double>> opt = {});
  /// List of [a, b, …] tuples of `arity` numbers each (polylines, tables), converted to SI, flattened row by row.
  void tuples(std::string_view key, std::vector<double>& out, std::size_t arity, Range each, std::size_t min_count, std::size_t max_count,
              Opt<std::vector<double>> opt = {});
  template <class E>
  void choice(std::string_view key, E& out, std::initializer_list<std::pair<std::string_view, E>> values, Opt<std::string> opt = {}) {
    std::vector<std::string_view> names;
    for (const auto& v : values) names.push_back(v.first);
    const int k = choice_index(key, names, opt);
    if (k >= 0) out = (values.begin() + k)->second;
  }
  /// Nested object. Absent and optional: `read` is called on an empty object so that the fallbacks inside apply (all keys inside must then
  /// have one, otherwise each missing key is an issue). Returns whether the key was in the file.
  bool object(std::string_view key, std::string_view help, const std::function<void(ObjectReader&)>& read, bool required = true);
  /// Like object() but skipped altogether when absent. Returns whether it was there (true in describe mode).
  bool optional_object(std::string_view key, std::string_view help, const std::function<void(ObjectReader&)>& read);
  void objects(std::string_view key, std::string_view help, std::size_t min_count, std::size_t max_count,
               const std::function<void(ObjectReader&, std::size_t index)>& read);
  /// Discriminated union: the string key `key` picks which branch reads the remaining keys of this same object.
  struct Branch {
    std::string name;
    std::string help;
    std::function<void(ObjectReader&)> read;
  };
  void pick(std::string_view key, std::string_view help, const std::vector<Branch>& branches);

  /// A problem found by a cross-field check, reported at this object's `key` ("" = the object itself).
  void issue(std::string_view key, std::string problem, std::string suggestion = {});
  bool describing() const;
  bool has(std::string_view key) const;  ///< whether the file gives this key (false in describe mode)
  std::string pointer() const;           ///< JSON pointer of this object

  struct Node;  // implementation (reader_node.h)
  explicit ObjectReader(Node& node) : node_(node) {}

 private:
  int choice_index(std::string_view key, const std::vector<std::string_view>& names, const Opt<std::string>& opt);
  Node& node_;
};

using ReadRoot = std::function<void(ObjectReader&)>;

/// "/json/pointer=value" from --set; value is JSON, or taken as a string when it does not parse.
struct Override {
  std::string pointer, value;
};
Override parse_override(std::string_view text);  ///< \throws UsageError

struct PlaceholderUse {
  std::string pointer, value, unit, help;
};

struct ReadOutcome {
  std::string file;
  std::vector<ConfigIssue> issues;
  std::string resolved_json;                 ///< canonical: sorted keys, every default filled in, round-trip numbers, paths as given; no white space
  std::vector<PlaceholderUse> placeholders;  ///< placeholder keys in use
  bool ok() const { return issues.empty(); }
  std::string subtree(std::string_view pointer) const;  ///< canonical JSON of a part of resolved_json, for hashing
  void throw_if_bad() const;                            ///< \throws ConfigError
};

/// \throws UsageError when the file cannot be read; syntax errors (with line and column), duplicate keys and everything else are issues.
ReadOutcome read_config_file(const std::filesystem::path& file, const std::vector<Override>& overrides, const ReadRoot& root);
ReadOutcome read_config_text(std::string_view json, const std::filesystem::path& base_folder, const std::vector<Override>& overrides,
                             const ReadRoot& root);
std::string describe_config_text(const ReadRoot& root);  ///< reference table of every key: pointer, type, unit, range, default, help, placeholder
std::string config_json_schema(const ReadRoot& root, std::string_view title);  ///< JSON Schema 2020-12
}  // namespace venato
