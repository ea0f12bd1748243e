#pragma once
/// One reader per section of a line config (house style 25: one declaration per key).
#include "line/config/line_config.h"
namespace venato::line {
void read_slab(ObjectReader& r, LineBasics& b);
void read_powders(ObjectReader& r, LineBasics& b);
void read_materials(ObjectReader& r, LineBasics& b);
void read_cut(ObjectReader& r, LineBasics& b);
void read_grid(ObjectReader& r, LineConfig& c);
void read_design(ObjectReader& r, DesignConfig& d);
void read_graphic(ObjectReader& r, GraphicConfig& g);
void read_vein_map(ObjectReader& r, VeinMapConfig& v);
void read_sync(ObjectReader& r, SyncConfig& s);
void read_masks(ObjectReader& r, MasksConfig& m);
}  // namespace venato::line
