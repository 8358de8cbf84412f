#include "eval/recording_views.hpp"

#include <utility>

#include "core/trajectory.hpp"

namespace fusebench {

Result<MeshViews> recorded_views(const Recording& recording, const RecordedViewOptions& options) {
  constexpr std::int64_t kMaxTruthGap_ns = 100'000'000;
  MeshViews views{recording.rig.camera, options.min_depth_m, options.max_depth_m, {}, options.culling};
  for (std::size_t frame = 0; frame < recording.frames.size(); frame += options.every_frames) {
    const auto pose =
        interpolate_pose(recording.ground_truth, recording.frames[frame].capture_ns, kMaxTruthGap_ns);
    if (!pose) continue;
    if (options.culling == Culling::depth) {
      auto loaded = recording.load_frame(frame);
      if (!loaded) return tl::unexpected(loaded.error());
      views.depth_m.push_back(std::move(loaded->depth_m));
    }
    views.T_truth_camera.push_back(*pose);
  }
  return views;
}

}  // namespace fusebench
