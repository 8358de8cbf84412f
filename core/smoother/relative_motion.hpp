// What images say about the motion of the camera between two frames, whatever the place of the IMU.
//
// The evidence of a frame is its pose against the model (and patches with depths of the model), so the pose
// that the images alone say, without the filter's prior, is known in the world of the run. That world
// wanders: the error of a pose is strongly correlated with that of the frame before, and their difference is
// small. Hence motions between neighbouring frames are what is used. The motion is between the two poses that
// the images say, not from the filter's pose of the earlier frame: where the prior has pulled that pose off
// the model, the next image sees the model. On simulated recordings the motion over a second is two to three
// times as good for it.
#pragma once

#include <cstddef>

#include "core/base/geometry.hpp"
#include "core/health/frame_report.hpp"

namespace fusebench::smoother {

/// Where the images alone put the camera. Covariance of (rotation: right, rad; position: world, m).
struct SeenPose {
  SE3 T_world_camera;
  Matrix6d covariance = Matrix6d::Zero();
};

/// The optimum of the evidence, which is of the IMU's pose, as a pose of the camera. T_imu_camera: the
/// extrinsic that the pipeline used, however wrong (identity without an IMU): images only ever saw the
/// camera. Directions that are known worse than 1 rad or 1 m stay where they are, with that uncertainty.
[[nodiscard]] SeenPose seen_pose(const health::PoseEvidence& evidence, const SE3& T_imu_camera);

/// The pose of one camera in the frame of another one. The error of T is (Log(R_measured^T R) in rad, t -
/// t_measured in m, axes of the reference camera).
struct RelativeCameraMotion {
  std::size_t reference = 0;  ///< index of the earlier frame
  std::size_t frame = 0;      ///< index of the later frame
  SE3 T_reference_camera;
  Matrix6d covariance = Matrix6d::Identity();
};

/// The motion between two such poses, whose errors are taken as independent (their scale is estimated later).
[[nodiscard]] RelativeCameraMotion motion_between(const SeenPose& reference, const SeenPose& camera);

/// The symmetric root of the information, so that residuals of neighbouring frames have the same axes.
[[nodiscard]] Matrix6d whitening(const RelativeCameraMotion& motion);

}  // namespace fusebench::smoother
