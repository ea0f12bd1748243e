#pragma once
#include <string_view>
#include "base/config/object_reader.h"
#include "dem/case.h"
namespace venato::dem {

/// Keys "materials" (list: name, kind grain|wall, moduli) and "pairs" (list: a, b, restitution, frictions) of the object that `r` reads.
/// Checks that names are unique, that pairs name known materials, none twice, and that every pair with a grain in it is there (a missing
/// pair is an issue that names it). Pairs of two walls are not needed; they never touch (restitution 1, no friction). Wall materials keep density 0.
void read_materials(ObjectReader& r, MaterialTable& table);

/// One powder: name, material (by name; must be a grain material) and sizes (Weibull by mass with both cuts, or monodisperse).
void read_powder(ObjectReader& r, const MaterialTable& table, Powder& powder);

/// Key `key`: the name of a material. -1 and an issue when there is none of that name (-1 without issue when the key itself is bad).
int read_material_name(ObjectReader& r, std::string_view key, const MaterialTable& table, std::string_view help);

/// Index of the material with this name, -1 = none.
int find_material(const MaterialTable& table, std::string_view name);
/// "a, b, c": for messages.
std::string material_names(const MaterialTable& table);
}  // namespace venato::dem
