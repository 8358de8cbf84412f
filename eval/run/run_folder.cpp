#include "eval/run/run_folder.hpp"

#include <vector>

#include "core/base/mesh/ply_file.hpp"
#include "eval/record/run_files/record_files.hpp"

namespace fusebench::run {

Result<void> write_run_folder(io::StagedFolder& folder, Mesh* mesh, std::span<const NamedText> texts,
                              record::RunRecord& record) {
  if (mesh != nullptr) {
    if (record.metrics.mesh.value) {
      const std::vector<double>& errors_m = record.metrics.mesh.value->vertex_errors_m;
      mesh->quality.assign(errors_m.begin(), errors_m.end());
    }
    if (auto written = mesh::write_ply(*mesh, folder.file("mesh.ply")); !written) return written;
  }
  for (const auto& [name, text] : texts) {
    if (text.empty()) continue;  // no truth, not kept or not asked for
    if (auto written = folder.write(name, text); !written) return written;
  }
  return run_files::commit_run(folder, record);
}

}  // namespace fusebench::run
