#include "eval/run/frames_again.hpp"

#include "eval/run/frame_source.hpp"

namespace fusebench::run {

Result<void> fuse_again(const PreparedRun& run, std::size_t count, systems::System& system,
                        const RunControl& control) {
  FrameSource source(run.recording, run.spec.threads > 1);
  for (std::size_t frame = 0; frame < count; ++frame) {
    if (control.is_stopped()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto loaded = source.next();
    if (!loaded) return tl::unexpected(loaded.error());
    if (auto fused = system.fuse_again(loaded->frame); !fused) return fused;
    if (control.progress) control.progress(frame + 1, run.recording.frames.size());
  }
  return {};
}

}  // namespace fusebench::run
