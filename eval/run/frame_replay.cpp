#include "eval/run/frame_replay.hpp"

#include "eval/run/frame_source.hpp"

namespace fusebench::run {

Result<void> FrameReplay::visit(const FrameVisitor& visitor) const {
  FrameSource source(run_.recording, run_.spec.threads > 1);
  for (std::size_t frame = 0; frame < seen_; ++frame) {
    if (control_.is_stopped()) return fail(ErrorCode::run_failed, "stopped by the user");
    const auto loaded = source.next();
    if (!loaded) return tl::unexpected(loaded.error());
    if (auto visited = visitor(loaded->frame); !visited) return visited;
    if (control_.progress) control_.progress(frame + 1, run_.recording.frames.size());
  }
  return {};
}

}  // namespace fusebench::run
