#include "line/stages/stage_api.h"
// Generated from the folders line/stages/*/stage.h: one #include and one VENATO_ENTRY(<folder>) each.
#include "line_stages_includes.inc"

namespace venato::line {

std::string_view to_string(ProductKind kind) {
  switch (kind) {
    case ProductKind::commands:
      return "commands";
    case ProductKind::partial_bed:
      return "a partial bed";
    case ProductKind::full_bed:
      return "a full bed";
    case ProductKind::slab:
      return "a slab";
  }
  return "?";
}

const std::vector<StageDescriptor>& all_stages() {
#define VENATO_ENTRY(folder) folder::descriptor(),
  static const std::vector<StageDescriptor> stages{
#include "line_stages_list.inc"
  };
#undef VENATO_ENTRY
  return stages;
}
}  // namespace venato::line
