#include "line/chain/order.h"

#include <algorithm>
namespace venato::line {
namespace {

bool takes(const StageDescriptor& d, ProductKind kind) { return std::find(d.consumes.begin(), d.consumes.end(), kind) != d.consumes.end(); }

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string out;
  for (const auto& w : words) out += (out.empty() ? "" : std::string(between)) + w;
  return out;
}

std::string wanted(const StageDescriptor& d) {
  std::vector<std::string> kinds;
  for (auto k : d.consumes) kinds.emplace_back(to_string(k));
  return joined(kinds, " or ");
}

std::string who_takes(ProductKind kind, const std::vector<StageDescriptor>& known) {
  std::vector<std::string> names;
  for (const auto& d : known)
    if (takes(d, kind)) names.emplace_back(d.name);
  return names.empty() ? "no stage takes " + std::string(to_string(kind))
                       : "stages that take " + std::string(to_string(kind)) + ": " + joined(names, ", ");
}
}  // namespace

std::vector<ConfigIssue> check_chain_order(const std::vector<ConfiguredStage>& chain, const std::vector<StageDescriptor>& known) {
  std::vector<ConfigIssue> issues;
  ProductKind have = ProductKind::commands;
  std::string from = "the chain starts with";
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const auto& d = *chain[i].descriptor;
    if (!takes(d, have))
      issues.push_back({chain[i].pointer + "/stage",
                        std::string(d.name) + " needs " + wanted(d) + ", but " + from + " " + std::string(to_string(have)), who_takes(have, known)});
    else if (i == 0 && !chain[i].stage.plan_commands)
      issues.push_back({chain[i].pointer + "/stage", std::string(d.name) + " cannot start a chain: it has no dosing heads to command",
                        "start with piezo_discharge"});
    have = d.produces;
    from = std::string(d.name) + " before it makes";
  }
  if (!chain.empty() && have != ProductKind::slab)
    issues.push_back({"/chain",
                      "the last stage, " + std::string(chain.back().descriptor->name) + ", makes " + std::string(to_string(have)) + ", not a slab",
                      "end the chain with press"});
  return issues;
}
}  // namespace venato::line
