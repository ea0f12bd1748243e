#pragma once
/// Parts of read_case (dem/case_reader.h), one per section of the file; private to it.
#include <string>
#include <string_view>
#include "base/config/object_reader.h"
#include "dem/case.h"
namespace venato::dem {

/// Three numbers of one unit. Keeps `out` when the key is bad. Without fallback the key is required.
void read_vec3(ObjectReader& r, std::string_view key, Vec3& out, Range range, Opt<std::vector<double>> opt);
/// List of [on, off) intervals in seconds, rising and apart. Absent = empty.
void read_intervals(ObjectReader& r, std::string_view key, std::vector<Interval>& out, std::string_view help);
/// Corners "low_mm" and "high_mm" with low < high; an issue when the region leaves the box.
void read_region(ObjectReader& r, const Case& c, Vec3& low, Vec3& high, std::string_view what);
/// "mass_fractions": one number per powder, sum 1 (to 1e-6, then exactly).
void read_fractions(ObjectReader& r, const Case& c, std::vector<double>& fractions);
/// An issue at `key` when two of the names are the same.
void check_unique(ObjectReader& r, std::string_view key, const std::vector<std::string>& names);
std::string mm_text(double metres);

void read_box(ObjectReader& r, Case& c);
void read_wall(ObjectReader& r, const Case& c, Wall& wall);
void read_motion(ObjectReader& r, WallMotion& motion);
void read_fill(ObjectReader& r, const Case& c, Fill& fill);
void read_rain(ObjectReader& r, const Case& c, Rain& rain);
void read_counter(ObjectReader& r, const Case& c, Counter& counter);
void read_snapshots(ObjectReader& r, const Case& c, SnapshotPlan& plan);
void read_fields(ObjectReader& r, Case& c);
/// Largest coarse-grained grain [m], 0 without powders.
double largest_grain(const Case& c);
}  // namespace venato::dem
