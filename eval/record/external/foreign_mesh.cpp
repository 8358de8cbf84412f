#include "eval/record/external/foreign_mesh.hpp"

#include <utility>

#include "core/base/mesh/mesh_file.hpp"

namespace fusebench::external {

Result<Mesh> read_foreign_mesh(const std::filesystem::path& file, double unit_m) {
  auto read = mesh::read_mesh(file);
  if (!read) return tl::unexpected(read.error());
  Mesh metric = mesh::scaled(*std::move(read), unit_m).cast<float>();
  metric.quality.clear();
  return metric;
}

}  // namespace fusebench::external
