// Camera views of a recording: ground-truth poses, intrinsics and depth images.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/mesh_error/mesh_views.hpp"

namespace fusebench::run {

struct RecordedViewOptions {
  double min_depth_m = 0;
  double max_depth_m = 0;
  mesh_error::Culling culling = mesh_error::Culling::occlusion;
  std::size_t every_frames = 10;  ///< interval of the used frames, from the first one on
};

/// The colour camera at frames of a recording, for frames within gaps of the ground truth up to 0.1 s;
/// with Culling::depth also their depth images. Errors: those of Recording::load_frame.
[[nodiscard]] Result<mesh_error::MeshViews> recorded_views(const recording::Recording& recording,
                                                           const RecordedViewOptions& options);

}  // namespace fusebench::run
