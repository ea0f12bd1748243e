#include "dem/vtk/vtk_writer.h"

#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "base/expects.h"
#include "base/io/atomic_file.h"

namespace venato::dem {
namespace {
static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

/// VTK's appended raw data: each array is a 64-bit byte count followed by its bytes; headers point to it by offset.
class Appended {
 public:
  template <class T>
  std::size_t add(const std::vector<T>& values) {
    const std::size_t offset = bytes_.size();
    const std::uint64_t count = values.size() * sizeof(T);
    append(&count, sizeof count);
    append(values.data(), count);
    return offset;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t n) {
    if (n > 0) bytes_.append(static_cast<const char*>(data), n);
  }
  std::string bytes_;
};

std::string array(const char* type, const char* name, int components, std::size_t offset) {
  char text[200];
  std::snprintf(text, sizeof text, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%zu\"/>\n", type, name,
                components, offset);
  return text;
}

std::vector<float> single(std::span<const Vec3> vectors) {
  std::vector<float> out;
  out.reserve(3 * vectors.size());
  for (const Vec3& v : vectors)
    for (int k = 0; k < 3; ++k) out.push_back(static_cast<float>(v[k]));
  return out;
}

std::vector<std::int32_t> counting(std::size_t n, std::int32_t first, std::int32_t step) {
  std::vector<std::int32_t> out(n);
  for (std::size_t k = 0; k < n; ++k) out[k] = first + static_cast<std::int32_t>(k) * step;
  return out;
}

std::string file_text(const std::string& piece, const Appended& data) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n" +
         piece + "</PolyData>\n<AppendedData encoding=\"raw\">\n_" + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

std::string numbered(const char* kind, int frame) {
  char name[40];
  std::snprintf(name, sizeof name, "%s_%06d.vtp", kind, frame);
  return name;
}

void write_pvd(const std::filesystem::path& folder, const char* kind, std::span<const double> times_s) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    char line[160];
    std::snprintf(line, sizeof line, "<DataSet timestep=\"%.9g\" part=\"0\" file=\"%s\"/>\n", times_s[k],
                  numbered(kind, static_cast<int>(k)).c_str());
    text += line;
  }
  write_text_atomically(folder / (std::string(kind) + ".pvd"), text + "</Collection>\n</VTKFile>\n");
}
}  // namespace

void write_grains_vtp(const std::filesystem::path& file, const VtkGrains& grains) {
  const std::size_t n = grains.position_m.size();
  VENATO_EXPECTS(grains.velocity_m_s.size() == n && grains.radius_m.size() == n && grains.species.size() == n && grains.id.size() == n);
  Appended data;
  std::string piece = "<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfVerts=\"" + std::to_string(n) +
                      "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"species\" Vectors=\"velocity_m_s\">\n";
  piece += array("Float32", "radius_m", 1, data.add(std::vector<float>(grains.radius_m.begin(), grains.radius_m.end())));
  piece += array("Float32", "velocity_m_s", 3, data.add(single(grains.velocity_m_s)));
  piece += array("Int32", "species", 1, data.add(std::vector<std::int32_t>(grains.species.begin(), grains.species.end())));
  piece += array("Int64", "id", 1, data.add(std::vector<std::int64_t>(grains.id.begin(), grains.id.end())));
  piece += "</PointData>\n<Points>\n" + array("Float32", "position_m", 3, data.add(single(grains.position_m))) + "</Points>\n<Verts>\n";
  piece += array("Int32", "connectivity", 1, data.add(counting(n, 0, 1)));
  piece += array("Int32", "offsets", 1, data.add(counting(n, 1, 1))) + "</Verts>\n</Piece>\n";
  write_text_atomically(file, file_text(piece, data));
}

void write_walls_vtp(const std::filesystem::path& file, const VtkWalls& walls) {
  const std::size_t n = walls.triangles.size();
  VENATO_EXPECTS(walls.wall.size() == n);
  std::vector<Vec3> corners;
  corners.reserve(3 * n);
  for (const Triangle& t : walls.triangles) corners.insert(corners.end(), {t.a, t.b, t.c});
  Appended data;
  std::string piece = "<Piece NumberOfPoints=\"" + std::to_string(3 * n) +
                      "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(n) +
                      "\">\n<CellData Scalars=\"wall\">\n";
  piece += array("Int32", "wall", 1, data.add(walls.wall));
  piece += "</CellData>\n<Points>\n" + array("Float32", "position_m", 3, data.add(single(corners))) + "</Points>\n<Polys>\n";
  piece += array("Int32", "connectivity", 1, data.add(counting(3 * n, 0, 1)));
  piece += array("Int32", "offsets", 1, data.add(counting(n, 3, 3))) + "</Polys>\n</Piece>\n";
  write_text_atomically(file, file_text(piece, data));
}

void write_vtk_frame(const std::filesystem::path& folder, int frame, const VtkGrains& grains, const VtkWalls& walls) {
  write_grains_vtp(folder / numbered("grains", frame), grains);
  write_walls_vtp(folder / numbered("walls", frame), walls);
}

void write_vtk_index(const std::filesystem::path& folder, std::span<const double> frame_times_s) {
  write_pvd(folder, "grains", frame_times_s);
  write_pvd(folder, "walls", frame_times_s);
}
}  // namespace venato::dem
