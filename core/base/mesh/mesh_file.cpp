#include "core/base/mesh/mesh_file.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "core/base/io/lower_case.hpp"
#include "core/base/mesh/obj_file.hpp"
#include "core/base/mesh/ply_file.hpp"

namespace fusebench::mesh {

Result<PreciseMesh> read_mesh(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    return fail(ErrorCode::usage, fmt::format("{}: a folder, where a mesh is needed", file.string()),
                "of a run it is mesh.ply; of a simulated recording the ground truth is scene.ply");
  }
  const std::string ending = io::lower_case(file.extension().string());
  if (ending == ".ply") return read_ply(file);
  if (ending == ".obj") return read_obj(file);
  return fail(
      ErrorCode::usage,
      fmt::format("{}: a mesh of the unknown ending '{}' (allowed .ply, .obj)", file.string(), ending),
      "convert the mesh to PLY");
}

PreciseMesh scaled(PreciseMesh mesh, double unit_m) {
  for (Vector3d& vertex : mesh.vertices) vertex *= unit_m;
  for (float& radius_m : mesh.radii_m) radius_m *= static_cast<float>(unit_m);
  return mesh;
}

}  // namespace fusebench::mesh
