#include "eval/run/revised_poses.hpp"

#include <fmt/format.h>

#include <utility>

#include "eval/run/frame_source.hpp"

namespace fusebench::run {

namespace {

/// Errors end the run.
Result<void> fuse_all_again(const PreparedRun& run, systems::System& system, const RunControl& control) {
  const recording::Recording& recording = run.recording;
  FrameSource source(recording, run.spec.threads > 1);
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    if (control.stop != nullptr && control.stop->load())
      return fail(ErrorCode::run_failed, "stopped by the user");
    const auto loaded = source.next();
    if (!loaded) return tl::unexpected(loaded.error());
    if (auto fused = system.fuse_again(loaded->frame); !fused) return fused;
    if (control.progress) control.progress(frame + 1, recording.frames.size());
  }
  return {};
}

}  // namespace

Result<std::optional<Trajectory>> revised_poses(const PreparedRun& run, systems::System& system,
                                                RunProgress& progress, const RunControl& control) {
  if (progress.status == record::RunStatus::failed || progress.frames.tracked == 0) return std::nullopt;
  auto revised = system.revise();
  if (revised && !*revised) return std::nullopt;
  Result<void> done;
  if (!revised) {
    done = tl::unexpected(revised.error());
  } else {
    done = fuse_all_again(run, system, control);
  }
  if (!done) {
    if (control.stop != nullptr && control.stop->load()) return tl::unexpected(done.error());
    progress.end(record::RunStatus::failed, "revising the poses: " + done.error().message);
    return std::nullopt;
  }
  progress.log +=
      fmt::format("poses revised at the end: {} frames, the model fused again\n", (*revised)->size());
  return revised;
}

RunOutput final_output(const Trajectory& revised, const RunOutput& online) {
  RunOutput output;
  output.has_filter = false;
  output.trajectory = revised;
  for (const filter::StampedEstimate& state : online.states)
    output.states.push_back({state.timestamp_ns, filter::GaussianState{}});
  output.mesh = online.mesh;
  return output;
}

}  // namespace fusebench::run
