#include "eval/run/run_folder.hpp"

#include "core/mesh/ply_file.hpp"
#include "eval/run_files/record_files.hpp"

namespace fusebench::run {

Result<void> write_run_folder(io::StagedFolder& folder, const Mesh* mesh, std::span<const NamedText> texts,
                              record::RunRecord& record) {
  if (mesh != nullptr) {
    if (auto written = mesh::write_ply(*mesh, folder.file("mesh.ply")); !written) return written;
  }
  for (const auto& [name, text] : texts) {
    if (text.empty()) continue;  // no truth, not kept or not asked for
    if (auto written = folder.write(name, text); !written) return written;
  }
  return run_files::commit_run(folder, record);
}

}  // namespace fusebench::run
