// Relative motion of the camera between two frames as measured by the images, independent of the IMU.
//
// The evidence of a frame is its pose relative to the model, without the prior of the filter, in the map
// frame of the run. The map drifts: the errors of consecutive poses are strongly correlated, and their
// difference is small. Therefore relative motions between neighbouring frames are used. The motion is between
// the two measured poses, not from the filter's pose of the earlier frame: if the prior moved that pose off
// the model, the next image is still aligned with the model. In simulated recordings this reduces the error
// of the motion over a second to a half or a third.
#pragma once

#include <cstddef>

#include "core/base/geometry.hpp"
#include "core/estimator/health/frame_report.hpp"

namespace fusebench::smoother {

/// Derivative of a pose or motion by timing errors (read-out of colour, read-out of depth, delay of depth;
/// s).
using ByTiming = Eigen::Matrix<double, 6, filter::kTimingSize>;

/// Camera pose as measured by the images, without the prior. Covariance of (rotation: right, rad; position:
/// world, m).
struct VisualPose {
  SE3 T_world_camera;
  Matrix6d covariance = Matrix6d::Zero();
  Vector3d timing_s = Vector3d::Zero();   ///< assumed timing errors
  ByTiming by_timing = ByTiming::Zero();  ///< derivative of the pose, in its tangent
};

/// Optimum of the evidence (a pose of the IMU), as a pose of the camera. T_imu_camera: the extrinsic that the
/// pipeline used, even if it is wrong (identity without an IMU), since images measure the camera only.
/// Directions with a standard deviation above 1 rad or 1 m are not corrected and keep that uncertainty.
[[nodiscard]] VisualPose visual_pose(const health::PoseEvidence& evidence, const SE3& T_imu_camera);

/// Pose of one camera in the frame of another one. The error of T is (Log(R_measured^T R) in rad, t -
/// t_measured in m, axes of the reference camera).
struct RelativeCameraMotion {
  std::size_t reference = 0;  ///< index of the earlier frame
  std::size_t frame = 0;      ///< index of the later frame
  SE3 T_reference_camera;
  Matrix6d covariance = Matrix6d::Identity();
  Vector3d timing_s = Vector3d::Zero();   ///< assumed timing errors
  ByTiming by_timing = ByTiming::Zero();  ///< derivative of the motion, in the tangent above
};

/// Information of the images of a frame on the timing, with the best pose for each timing: the residual root
/// * (timing - timing_s) + residual has unit covariance by the noise model of the filter.
struct VisualTiming {
  std::size_t frame = 0;
  Vector3d timing_s = Vector3d::Zero();
  Matrix3d root = Matrix3d::Zero();      ///< symmetric root of the information
  Vector3d residual = Vector3d::Zero();  ///< zero along unobservable directions
  int rank = 0;                          ///< of the information
};

/// Frames without motion or angular acceleration give little or no information.
[[nodiscard]] VisualTiming visual_timing(const health::PoseEvidence& evidence);

/// The motion between two poses with errors that are treated as independent (their scale is estimated later).
/// Its timing is that of the later one.
[[nodiscard]] RelativeCameraMotion motion_between(const VisualPose& reference, const VisualPose& camera);

/// Symmetric root of the information, so that residuals of neighbouring frames have the same axes.
[[nodiscard]] Matrix6d whitening(const RelativeCameraMotion& motion);

}  // namespace fusebench::smoother
