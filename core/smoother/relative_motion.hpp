// Relative motion of the camera between two frames as measured by the images, independent of the IMU.
//
// The evidence of a frame is its pose against the model (and patches with depths of the model), so the
// measured pose, without the filter's prior, is known in the map frame of the run. The map frame drifts: the
// error of a pose is strongly correlated with that of the frame before, and their difference is small. Hence
// relative motions between neighbouring frames are used. The motion is between the two measured poses, not
// from the filter's pose of the earlier frame: where the prior has pulled that pose off the model, the next
// image is still aligned with the model. On simulated recordings this reduces the error of the motion over a
// second to a half or a third.
#pragma once

#include <cstddef>

#include "core/base/geometry.hpp"
#include "core/health/frame_report.hpp"

namespace fusebench::smoother {

/// Camera pose as measured by the images, without the prior. Covariance of (rotation: right, rad; position:
/// world, m).
struct VisualPose {
  SE3 T_world_camera;
  Matrix6d covariance = Matrix6d::Zero();
};

/// The optimum of the evidence, which is of the IMU's pose, as a pose of the camera. T_imu_camera: the
/// extrinsic that the pipeline used, even if it is wrong (identity without an IMU), since images measure the
/// camera only. Directions whose standard deviation exceeds 1 rad or 1 m are not corrected and keep that
/// uncertainty.
[[nodiscard]] VisualPose visual_pose(const health::PoseEvidence& evidence, const SE3& T_imu_camera);

/// The pose of one camera in the frame of another one. The error of T is (Log(R_measured^T R) in rad, t -
/// t_measured in m, axes of the reference camera).
struct RelativeCameraMotion {
  std::size_t reference = 0;  ///< index of the earlier frame
  std::size_t frame = 0;      ///< index of the later frame
  SE3 T_reference_camera;
  Matrix6d covariance = Matrix6d::Identity();
};

/// The motion between two such poses, whose errors are taken as independent (their scale is estimated later).
[[nodiscard]] RelativeCameraMotion motion_between(const VisualPose& reference, const VisualPose& camera);

/// The symmetric root of the information, so that residuals of neighbouring frames have the same axes.
[[nodiscard]] Matrix6d whitening(const RelativeCameraMotion& motion);

}  // namespace fusebench::smoother
