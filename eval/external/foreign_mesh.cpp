#include "eval/external/foreign_mesh.hpp"

#include "core/mesh/mesh_file.hpp"

namespace fusebench::external {

Result<Mesh> read_foreign_mesh(const std::filesystem::path& file, double unit_m) {
  auto read = mesh::read_mesh(file);
  if (!read) return tl::unexpected(read.error());
  for (Vector3d& vertex : read->vertices) vertex *= unit_m;
  for (float& radius_m : read->radii_m) radius_m *= static_cast<float>(unit_m);
  Mesh mesh = read->cast<float>();
  mesh.quality.clear();
  return mesh;
}

}  // namespace fusebench::external
