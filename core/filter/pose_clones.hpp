// Stochastic clones of the pose (Roumeliotis & Burdick 2002): errors of the reference frame, which the
// patches were cut from, and of the model. A photometric residual measures the motion since the reference
// frame; a geometric one measures the pose relative to the model, which was built at estimated poses and
// drifts with them.
//
// Between fusions the pose, velocity and gravity of the filter are relative to the model. When a frame is
// fused, the model takes over a share of its pose error: this share is from then on an error of the model
// relative to the first camera (kModelPose).
//
// An image of which the rows are read one after the other is compensated by the motion that is known, and
// keeps a distortion by the error of it. Both what the patches were cut from and the model have such errors
// (kReferenceRate, kModelRate): images that are distorted alike say nothing of the motion. Nor do they say
// anything of the read-out: a model of frames that were read during the same motion, by a wrong read-out, has
// their distortion (FusedReadout).
#pragma once

#include "core/filter/color_drift.hpp"
#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// Carries a pose error from one pose to another that is rigidly attached to it: tangents of T_world_imu
/// (right rotation in rad, world position in m).
[[nodiscard]] Matrix6d pose_transport(const SE3& to, const SE3& from);

/// The same of what is undone in the model, by pose_transport().
[[nodiscard]] FusedReadout transported(const Matrix6d& transport, const FusedReadout& readout);

/// Two poses, the timing of the sensors, and the motion during the read-out, against that of either.
inline constexpr int kMeasuredSize = 2 * kPoseSize + kReadoutSize;

/// What images measure, as linear combinations of the error state: the pose against the reference frame (rows
/// 0-5) and against the model (rows 6-11), both in the tangent of the pose, the timing of the sensors (rows
/// 12-14: read-out of colour, read-out of depth, delay of depth), nothing (row 15, for what is known), and
/// the rate of the pose against the error of that in the reference (rows 16-21) and in the model (rows
/// 22-27).
[[nodiscard]] Eigen::Matrix<double, kMeasuredSize, kStateSize> measured_combinations(
    const FilterState& state);

/// How the model follows the frames that are fused into it.
struct ModelDrift {
  double share = 0;   ///< of a frame's pose error that the model takes over, 0 to 1
  double factor = 1;  ///< how much larger its drift is than that of independent errors (sigmas)
};

/// What was undone in the images of a frame.
struct UndoneReadout {
  Vector6d rate_left = Vector6d::Zero();  ///< of its rate, what was not
  Vector6d rate = Vector6d::Zero();       ///< what was
  Vector3d timing_s = Vector3d::Zero();   ///< the errors of the timing that were supposed: SensorErrors
};

/// The frame was fused: the model takes over a share of its pose error. The reference pose, which is given in
/// the world of the model as the pose is, moves with it.
[[nodiscard]] GaussianState fused_into_model(const GaussianState& state, const ModelDrift& drift,
                                             const UndoneReadout& undone = {});

/// The next patches are cut from this frame: its pose becomes the reference pose.
[[nodiscard]] GaussianState cloned_as_reference(const GaussianState& state, const UndoneReadout& undone = {});

/// The error that colour adds to the reference pose in a frame (color_drift.hpp).
[[nodiscard]] GaussianState with_reference_noise(GaussianState state, const ReferenceNoise& noise);

/// The error that the noise of an anchor's own image adds to the reference pose by colour: covariance
/// (information + W)^-1, where `information` (6x6, tangent of the pose) is that of one frame against an
/// anchor, and W limits what colour does not observe to 0.01 rad and 0.1 m (sigmas).
[[nodiscard]] GaussianState with_anchor_noise(GaussianState state, const Matrix6d& information);

/// The state with the errors of another model in place of those of its own: of `there`, at the reference pose
/// of that state.
[[nodiscard]] GaussianState with_model_of(const GaussianState& state, const GaussianState& there);

/// The estimate in the world of the first camera: the uncertainty of the model's pose is added to that of the
/// pose, the velocity and the direction of gravity.
[[nodiscard]] GaussianState in_first_camera_world(const GaussianState& state);

}  // namespace fusebench::filter
