// PLY meshes.
#include <algorithm>

#include "core/base/mesh/ply_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace mesh;

void ply(std::string_view bytes) {
  static const MemoryFile file("mesh.ply");
  file.write(bytes);
  const auto mesh = read_ply(file.path());
  if (!mesh) return check_error(mesh.error(), file.path());
  const std::size_t count = mesh->vertices.size();
  check(count <= bytes.size() && mesh->triangles.size() <= bytes.size(), "an item takes at least a byte");
  check(mesh->normals.empty() || mesh->normals.size() == count, "no normals or one a vertex");
  check(mesh->colors.empty() || mesh->colors.size() == count, "no colours or one a vertex");
  check(std::ranges::all_of(mesh->vertices, [](const Vector3d& v) { return v.allFinite(); }),
        "vertices are finite");
  for (const auto& triangle : mesh->triangles) {
    check(std::ranges::all_of(triangle, [&](std::uint32_t i) { return i < count; }), "indices are vertices");
  }
  const Mesh written = mesh->cast<float>();
  check(write_ply(written, file.path()).has_value(), "a mesh can be written");
  const auto again = read_ply(file.path());
  check(again && again->cast<float>().vertices == written.vertices && again->triangles == mesh->triangles,
        "what is written reads back");
}

}  // namespace fusebench::fuzz
