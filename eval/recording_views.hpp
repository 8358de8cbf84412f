// From where a recording saw its scene.
#pragma once

#include <cstddef>

#include "core/error.hpp"
#include "datasets/recording.hpp"
#include "eval/mesh/mesh_views.hpp"

namespace fusebench {

struct RecordedViewOptions {
  double min_depth_m = 0;
  double max_depth_m = 0;
  Culling culling = Culling::occlusion;
  std::size_t every_frames = 10;  ///< the first frame, and every so many after it
};

/// The true colour cameras at frames of a recording, where its ground truth has no gap of more than 0.1 s;
/// with Culling::depth also their depth images. Errors: those of Recording::load_frame.
[[nodiscard]] Result<MeshViews> recorded_views(const Recording& recording,
                                               const RecordedViewOptions& options);

}  // namespace fusebench
