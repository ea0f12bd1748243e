#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <cmath>
#include <string>

#include "base/error.h"
#include "dem/case.h"

namespace venato::dem {
namespace {
constexpr std::size_t kMaxTriangles = 2'000'000;         // a drawn hopper has 1e2..1e5; more is a scan or a mistake
constexpr std::uintmax_t kMaxFileBytes = 1'000'000'000;  // ASCII STL of kMaxTriangles is ~ 5e8 bytes

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) { throw UsageError("mesh " + file.string() + ": " + why); }

void require_plain_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) refuse(file, "no such file");
  if (!std::filesystem::is_regular_file(status)) refuse(file, "is not a regular file");
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) refuse(file, "cannot be read: " + error.message());
  if (bytes == 0) refuse(file, "the file is empty (0 bytes)");
  if (bytes > kMaxFileBytes) refuse(file, std::to_string(bytes) + " bytes is more than the limit of " + std::to_string(kMaxFileBytes));
}

Vec3 metres(const aiVector3D& v, double scale) { return scale * Vec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)); }

void append_triangles(const aiMesh& part, double scale, const std::filesystem::path& file, MeshShape& mesh) {
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines of mixed meshes
    Vec3 corner[3];
    for (int k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= part.mNumVertices) refuse(file, "face " + std::to_string(f) + " points to a vertex that is not there");
      corner[k] = metres(part.mVertices[face.mIndices[k]], scale);
      if (!corner[k].allFinite()) refuse(file, "face " + std::to_string(f) + " has a vertex that is not a finite number");
    }
    // A sliver without area has no normal; the nearest-point contact finds its neighbours instead.
    const Vec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    if (ab.cross(ac).norm() <= 1e-12 * ab.norm() * ac.norm() || ab.norm() == 0 || ac.norm() == 0) continue;
    mesh.triangles.push_back({corner[0], corner[1], corner[2]});
    if (mesh.triangles.size() > kMaxTriangles) refuse(file, "more than " + std::to_string(kMaxTriangles) + " triangles; simplify the mesh");
  }
}
}  // namespace

MeshShape load_mesh(const std::filesystem::path& file, double scale_to_m) {
  if (!(scale_to_m > 0) || !std::isfinite(scale_to_m)) refuse(file, "the scale to metres must be > 0, is " + std::to_string(scale_to_m));
  require_plain_file(file);
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // No welding, no generated normals: contacts are found by nearest points, only corner positions are used.
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr) refuse(file, std::string("not a mesh that can be read (STL, OBJ, PLY …): ") + importer.GetErrorString());
  MeshShape mesh;
  for (unsigned k = 0; k < scene->mNumMeshes; ++k) append_triangles(*scene->mMeshes[k], scale_to_m, file, mesh);
  if (mesh.triangles.empty()) refuse(file, "holds no triangle with an area");
  return mesh;
}
}  // namespace venato::dem
