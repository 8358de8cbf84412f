#include "eval/run/foreign_output.hpp"

#include <utility>

namespace fusebench::run {

RunOutput foreign_output(const external::FramePoses& frames, Mesh mesh) {
  RunOutput output;
  output.has_filter = false;
  output.trajectory = frames.poses;
  for (const auto& [stamp_ns, instant_ns] : frames.stamps) output.states.push_back({instant_ns, {}});
  output.mesh = std::move(mesh);
  return output;
}

void describe_foreign_output(const RunOutput& output, const recording::Recording& recording,
                             record::RunRecord& record) {
  record.frames.total = recording.frames.size();
  record.frames.tracked = output.trajectory.size();
  record.frames.lost = record.frames.total - record.frames.tracked;
  record.model = {output.mesh.vertices.size(), output.mesh.triangles.size(), 0};
}

}  // namespace fusebench::run
