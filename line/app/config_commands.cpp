#include <cstdio>

#include "dem/case_reader.h"
#include "line/app/commands.h"
#include "line/chain/check_line.h"
namespace venato::line::app {
namespace {
std::vector<Override> overrides_of(const Options& o) {
  std::vector<Override> out;
  for (const auto& text : o.overrides) out.push_back(parse_override(text));
  return out;
}
}  // namespace

int validate_command(const Options& o, Context& context) {
  const auto config = load_line_config(o.input, overrides_of(o));
  check_line(config);
  std::fputs(cost_table(config, estimate_line_cost(config, context.store, context.threads)).c_str(), stdout);
  return 0;
}

int describe_command(const Options& o) {
  const ReadRoot dem_root = [](ObjectReader& r) {
    dem::Case c;
    dem::read_case(r, c);
  };
  const ReadRoot root = o.dem ? dem_root : line_config_root(all_stages());
  const auto text = o.schema ? config_json_schema(root, o.dem ? "venato-dem" : "venato-line") : describe_config_text(root);
  std::fputs(text.c_str(), stdout);
  if (!text.ends_with('\n')) std::fputc('\n', stdout);
  return 0;
}
}  // namespace venato::line::app
