#include "core/mesh/scaled_mesh.hpp"

namespace fusebench::mesh {

PreciseMesh scaled(PreciseMesh mesh, double unit_m) {
  for (Vector3d& vertex : mesh.vertices) vertex *= unit_m;
  for (float& radius_m : mesh.radii_m) radius_m *= static_cast<float>(unit_m);
  return mesh;
}

}  // namespace fusebench::mesh
