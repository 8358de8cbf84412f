#include "eval/run/revised_poses.hpp"

#include <fmt/format.h>

#include <utility>

namespace fusebench::run {

Result<std::optional<Trajectory>> revised_poses(systems::System& system, RunProgress& progress,
                                                const RunControl& control) {
  if (progress.status == record::RunStatus::failed || progress.frames.tracked == 0) return std::nullopt;
  auto revised = system.revise();
  if (!revised) {
    if (control.is_stopped()) return tl::unexpected(revised.error());
    progress.end(record::RunStatus::failed, "revising the poses: " + revised.error().message);
    return std::nullopt;
  }
  if (!*revised) return std::nullopt;
  progress.log +=
      fmt::format("poses revised at the end: {} frames, the model fused again\n", (*revised)->size());
  return revised;
}

RunOutput final_output(const Trajectory& revised, const RunOutput& online) {
  RunOutput output;
  output.has_filter = false;
  output.trajectory = revised;
  for (const filter::StampedEstimate& state : online.states)
    output.states.push_back({state.timestamp_ns, {}});
  output.mesh = online.mesh;
  return output;
}

}  // namespace fusebench::run
