#include "dem/rigs/rig_api.h"
// Generated from the folders dem/rigs/*/rig.h: one #include and one VENATO_ENTRY(<folder>) each.
#include "dem_rigs_includes.inc"

namespace venato::dem {

const std::vector<RigDescriptor>& all_rigs() {
#define VENATO_ENTRY(folder) rigs::folder::descriptor(),
  static const std::vector<RigDescriptor> rigs{
#include "dem_rigs_list.inc"
  };
#undef VENATO_ENTRY
  return rigs;
}

void read_rig(ObjectReader& r, Case& c) {
  r.optional_object("rig", "bench rig: what is measured when the case is done", [&c](ObjectReader& o) {
    std::vector<ObjectReader::Branch> branches;
    for (const RigDescriptor& d : all_rigs())
      branches.push_back(
          {std::string(d.name), std::string(d.help), [&c, &d](ObjectReader& b) { c.rig = std::make_shared<const Rig>(d.read(b, c)); }});
    o.pick("kind", "which rig", branches);
  });
}
}  // namespace venato::dem
