#pragma once
#include <string>

#include "base/h5/h5_file.h"
#include "dem/fields/field_recorder.h"
namespace venato::dem {

/// Writes the fields of a case under `group` ("/fields/"): grid axes, densities, velocity, temperature, stresses, wall force, the scan over widths
/// and, where measured, the diffusivity.
void write_fields(H5Writer& file, const std::string& group, const FieldResult& fields);
}  // namespace venato::dem
