// What the benchmarks of the estimator's kernels work on: a frame, the frames before it, and the model that
// these were fused into. Of the textured room in closed form, or of a recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/config.hpp"
#include "core/preprocessing/rolling_shutter_compensation.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::testing {

enum class SceneKind : std::int64_t { room = 0, recording = 1 };

/// A frame that was fused.
struct FusedView {
  GreyImage grey;
  DepthImage depth_m;
  SE3 T_world_camera;
};

struct BenchScene {
  SceneKind kind = SceneKind::room;
  config::Config config;
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

/// Made once. The room: 67 degrees of view at a width of 320 or 640 pixels, three near views, the last of
/// which is the frame, rendered. The recording: 640 pixels, frame 30 of it, and the 30 frames before that as
/// the estimator tracked and fused them with a synthetic IMU. What cannot be read or tracked throws
/// (check()).
[[nodiscard]] const BenchScene& bench_scene(SceneKind kind, int width_px);

/// The folder of the recording below FUSEBENCH_DATA, or why there is none (data_missing).
[[nodiscard]] Result<std::filesystem::path> recorded_folder();

}  // namespace fusebench::testing
