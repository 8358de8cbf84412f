// What the benchmarks of the estimator's kernels work on: a frame, the frames before it, and the model that
// these were fused into. Of the textured room in closed form, or of a recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "tests/bench/scene_kinds.hpp"

namespace fusebench::testing {

/// A frame that was fused.
struct FusedView {
  GreyImage grey;
  DepthImage depth_m;
  SE3 T_world_camera;
};

/// The options that the scene is made with.
struct SceneOptions {
  config::PatchConfig patches;
  config::DepthConfig depth;
  config::TsdfConfig tsdf;
};

struct BenchScene {
  SceneKind kind = SceneKind::room;
  SceneOptions config;
  PinholeCamera camera;
  SensorTiming timing;
  preprocessing::CameraVelocity velocity;  ///< at the frame
  SE3 T_world_camera;            ///< of the frame: exact in the room, the ground truth of the recording
  RgbdFrame sensed;              ///< the frame as a rolling shutter reads it
  RgbdFrame frame;               ///< as it is fused: of one instant; the recording's depth is gated
  DepthImage ungated_depth_m;    ///< of `frame`, before that
  std::vector<FusedView> views;  ///< in the model; patches are cut from the last one
  tsdf::TsdfVolume model{config.tsdf};

  [[nodiscard]] preprocessing::FrameTiming frame_timing() const {
    return preprocessing::frame_timing(sensed, timing);
  }
};

}  // namespace fusebench::testing
