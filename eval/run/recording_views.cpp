#include "eval/run/recording_views.hpp"

#include <utility>

#include "eval/record/record_origin.hpp"

namespace fusebench::run {

Result<mesh_error::MeshViews> recorded_views(const recording::Recording& recording,
                                             const RecordedViewOptions& options) {
  mesh_error::MeshViews views{
      recording.rig.camera, options.min_depth_m, options.max_depth_m, {}, options.culling};
  for (std::size_t frame = 0; frame < recording.frames.size(); frame += options.every_frames) {
    const auto pose = record::true_camera(recording, recording.frames[frame].capture_ns);
    if (!pose) continue;
    if (options.culling == mesh_error::Culling::depth) {
      auto loaded = recording.load_frame(frame);
      if (!loaded) return tl::unexpected(loaded.error());
      views.depth_m.push_back(std::move(loaded->depth_m));
    }
    views.T_truth_camera.push_back(*pose);
  }
  return views;
}

}  // namespace fusebench::run
