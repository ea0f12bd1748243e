#include "dem/case_outputs/csv.h"

#include <cmath>
#include <cstdio>

#include "dem/case_outputs/labels.h"

namespace venato::dem {
namespace {
std::string number(double value) {
  if (std::isnan(value)) return "";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}
// Appends one by one: g++ 12 warns wrongly (-Wrestrict) about "," + temporary.
void append(std::string& line, double value) {
  line += ',';
  line += number(value);
}
void append(std::string& line, const std::string& text) {
  line += ',';
  line += text;
}
void append(std::string& line, const Vec3& v, double scale) {
  for (int k = 0; k < 3; ++k) append(line, v[k] * scale);
}
constexpr double kMm = 1e3, kUm = 1e6, kUg = 1e9, kG = 1e3, kUj = 1e6;
}  // namespace

std::string kpi_csv(const std::vector<Kpi>& kpis) {
  std::string text = "name,value,standard_error,unit,description,error_from\n";
  for (const Kpi& k : kpis) {
    text += k.name;
    append(text, k.value);
    append(text, k.standard_error);
    append(text, k.unit);
    text += ",\"";
    text += k.description;
    text += "\"";
    append(text, k.error_from);
    text += "\n";
  }
  return text;
}

std::string table_csv(const RigTable& table) {
  std::string text;
  for (const RigTable::Column& column : table.columns) {
    if (!text.empty()) text += ',';
    text += column.name;
  }
  text += '\n';
  const std::size_t rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      if (k > 0) text += ',';
      text += number(table.columns[k].values[i]);
    }
    text += '\n';
  }
  return text;
}

std::string kpi_text(const std::vector<Kpi>& kpis) {
  std::string text;
  for (const Kpi& k : kpis) {
    char line[256];
    if (std::isnan(k.value))
      std::snprintf(line, sizeof line, "%-36s not known", k.name.c_str());
    else if (std::isnan(k.standard_error))
      std::snprintf(line, sizeof line, "%-36s %.6g %s", k.name.c_str(), k.value, k.unit.c_str());
    else
      std::snprintf(line, sizeof line, "%-36s %.5g +- %.2g %s  (%s)", k.name.c_str(), k.value, k.standard_error, k.unit.c_str(),
                    k.error_from.empty() ? "standard error" : k.error_from.c_str());
    text += line;
    text += '\n';
  }
  return text;
}

std::string series_csv(const Case& c, const TimeSeries& s) {
  std::string text = "time_s,grains,mass_g,kinetic_energy_uj,mean_contacts,max_speed_m_s,top_z_mm";
  for (std::size_t k = 0; k < s.counter_mass_kg.size(); ++k) append(text, counter_label(c, k) + "_mass_g");
  for (std::size_t k = 0; k < s.wall_force_n.size(); ++k)
    for (const char* axis : {"x", "y", "z"}) append(text, wall_label(c, k) + "_force_" + axis + "_n");
  text += "\n";
  for (std::size_t i = 0; i < s.time_s.size(); ++i) {
    std::string line = number(s.time_s[i]);
    append(line, s.grain_count[i]);
    append(line, s.mass_kg[i] * kG);
    append(line, s.kinetic_energy_j[i] * kUj);
    append(line, s.mean_contacts[i]);
    append(line, s.max_speed_m_s[i]);
    append(line, s.top_z_m[i] * kMm);
    for (const auto& row : s.counter_mass_kg) append(line, row[i] * kG);
    for (const auto& row : s.wall_force_n) append(line, row[i], 1);
    text += line + "\n";
  }
  return text;
}

std::string counter_csv(const Case& c, const std::vector<CounterRecord>& records) {
  std::string text = "time_s,x_mm,y_mm,z_mm,vx_m_s,vy_m_s,vz_m_s,diameter_um,mass_ug,powder,id,birth_time_s,birth_x_mm,birth_y_mm,birth_z_mm\n";
  for (const CounterRecord& r : records) {
    std::string line = number(r.time_s);
    append(line, r.position_m, kMm);
    append(line, r.velocity_m_s, 1);
    append(line, r.diameter_m * kUm);
    append(line, r.mass_kg * kUg);
    append(line, r.species >= 0 && static_cast<std::size_t>(r.species) < c.powders.size() ? powder_label(c, static_cast<std::size_t>(r.species))
                                                                                          : std::string());
    append(line, std::to_string(r.id));
    append(line, r.birth_time_s);
    append(line, r.birth_position_m, kMm);
    text += line + "\n";
  }
  return text;
}
}  // namespace venato::dem
