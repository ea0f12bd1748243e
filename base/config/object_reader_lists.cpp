#include <algorithm>
#include <system_error>

#include "base/config/object_reader.h"
#include "base/config/reader_node.h"
#include "base/config/suggest.h"
#include "base/expects.h"
#include "base/units.h"

// Lists of numbers, tables of tuples and paths.
namespace venato {
namespace fs = std::filesystem;
namespace {

KeyDeclaration list_declaration(std::string_view key, KeyKind kind, const Range& each, std::size_t min_count, std::size_t max_count,
                                const Opt<std::vector<double>>& opt, std::size_t arity) {
  KeyDeclaration d;
  d.key = key;
  d.kind = kind;
  d.help = opt.help;
  d.min = each.min;
  d.max = each.max;
  d.unit = each.unit;
  d.why = each.why;
  d.min_count = min_count;
  d.max_count = max_count;
  d.arity = arity;
  d.placeholder = opt.placeholder;
  d.required = !opt.fallback.has_value();
  si_factor(each.unit);
  if (!opt.fallback) return d;
  JsonValue::Array rows;
  if (kind == KeyKind::numbers) {
    rows.assign(opt.fallback->begin(), opt.fallback->end());
  } else {
    VENATO_EXPECTS(opt.fallback->size() % arity == 0);
    for (std::size_t i = 0; i < opt.fallback->size(); i += arity)
      rows.emplace_back(
          JsonValue::Array(opt.fallback->begin() + static_cast<std::ptrdiff_t>(i), opt.fallback->begin() + static_cast<std::ptrdiff_t>(i + arity)));
  }
  d.fallback = JsonValue(std::move(rows));
  return d;
}

std::string counted(std::size_t n, std::string_view one) { return std::to_string(n) + " " + std::string(one) + (n == 1 ? "" : "s"); }

bool count_fits(ObjectReader::Node& node, std::string_view key, std::size_t n, std::size_t min_count, std::size_t max_count, std::string_view one) {
  if (n >= min_count && n <= max_count) return true;
  std::string limits;
  if (min_count == max_count)
    limits = "exactly " + counted(min_count, one);
  else if (n < min_count)
    limits = "at least " + counted(min_count, one);
  else
    limits = "at most " + counted(max_count, one);
  node.add_issue(key, "must have " + limits + ", has " + std::to_string(n));
  return false;
}

JsonValue as_doubles(const JsonValue& value) {  // 1 and 1.0 are the same number: one canonical text
  if (value.is_number()) return JsonValue(value.as_double());
  JsonValue::Array out;
  for (const JsonValue& item : *value.array()) out.push_back(as_doubles(item));
  return JsonValue(std::move(out));
}

/// "did you mean 'veins.png'?" from the folder where the missing file was looked for.
std::string similar_file(const fs::path& wanted) {
  std::error_code error;
  std::vector<std::string> names;
  constexpr std::size_t kEnough = 2000;
  for (fs::directory_iterator it(wanted.parent_path(), error), end; !error && it != end && names.size() < kEnough; it.increment(error))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string meant = nearest(wanted.filename().string(), names);
  return meant.empty() ? "" : "did you mean '" + meant + "'?";
}
}  // namespace

void ObjectReader::numbers(std::string_view key, std::vector<double>& out, Range each, std::size_t min_count, std::size_t max_count,
                           Opt<std::vector<double>> opt) {
  const JsonValue* value = node_.declare(list_declaration(key, KeyKind::numbers, each, min_count, max_count, opt, 1));
  if (!value) return;
  const std::string where = pointer_join(node_.pointer, key);
  const JsonValue::Array* list = value->array();
  if (!list) {
    add_type_issue(node_, where, "a list of numbers", *value);
    return;
  }
  bool good = count_fits(node_, key, list->size(), min_count, max_count, "number");
  std::vector<double> si(list->size());
  for (std::size_t i = 0; i < list->size(); ++i) good &= read_number(node_, pointer_join(where, std::to_string(i)), (*list)[i], each, si[i]);
  if (!good) return;
  out = std::move(si);
  node_.resolved.insert_or_assign(std::string(key), as_doubles(*value));
}

void ObjectReader::tuples(std::string_view key, std::vector<double>& out, std::size_t arity, Range each, std::size_t min_count, std::size_t max_count,
                          Opt<std::vector<double>> opt) {
  VENATO_EXPECTS(arity >= 1);
  const JsonValue* value = node_.declare(list_declaration(key, KeyKind::tuples, each, min_count, max_count, opt, arity));
  if (!value) return;
  const std::string where = pointer_join(node_.pointer, key);
  const std::string row_kind = "a list of " + counted(arity, "number");
  const JsonValue::Array* rows = value->array();
  if (!rows) {
    add_type_issue(node_, where, "a list, each item " + row_kind, *value);
    return;
  }
  bool good = count_fits(node_, key, rows->size(), min_count, max_count, "item");
  std::vector<double> si;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const std::string at = pointer_join(where, std::to_string(i));
    const JsonValue::Array* row = (*rows)[i].array();
    if (!row || row->size() != arity) {
      if (row)
        node_.add_issue_at(at, "must be " + row_kind + ", has " + std::to_string(row->size()));
      else
        add_type_issue(node_, at, row_kind, (*rows)[i]);
      good = false;
      continue;
    }
    for (std::size_t j = 0; j < arity; ++j) {
      double number = 0;
      good &= read_number(node_, pointer_join(at, std::to_string(j)), (*row)[j], each, number);
      si.push_back(number);
    }
  }
  if (!good) return;
  out = std::move(si);
  node_.resolved.insert_or_assign(std::string(key), as_doubles(*value));
}

void ObjectReader::path(std::string_view key, fs::path& out, PathKind kind, Opt<std::string> opt) {
  KeyDeclaration d;
  d.key = key;
  d.kind = KeyKind::path;
  d.help = opt.help;
  d.placeholder = opt.placeholder;
  d.required = !opt.fallback.has_value();
  if (opt.fallback) d.fallback = JsonValue(*opt.fallback);
  const JsonValue* value = node_.declare(std::move(d));
  if (!value) return;
  const std::string* given = value->text();
  if (!given) {
    add_type_issue(node_, pointer_join(node_.pointer, key), "a string", *value);
    return;
  }
  const bool none_is_allowed = opt.fallback && opt.fallback->empty();
  if (given->empty() && none_is_allowed) {
    out.clear();
    node_.resolved.insert_or_assign(std::string(key), *value);
    return;
  }
  if (given->empty() || given->find('\0') != std::string::npos) {
    node_.add_issue(key, "must be a path, is " + short_text(*value));
    return;
  }
  fs::path full = *given;
  if (full.is_relative()) full = node_.state->base_folder / full;
  std::error_code error;
  if (kind == PathKind::existing_file && !fs::is_regular_file(full, error)) {
    const bool folder = fs::is_directory(full, error);
    node_.add_issue(key, "'" + *given + "' is not a file (looked for " + full.lexically_normal().string() + (folder ? ", which is a folder)" : ")"),
                    folder ? "" : similar_file(full));
    return;
  }
  out = full.lexically_normal();
  node_.resolved.insert_or_assign(std::string(key), *value);
}
}  // namespace venato
