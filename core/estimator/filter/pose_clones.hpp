// Stochastic clones of the pose (Roumeliotis & Burdick 2002): errors of the reference frame of the patches
// and of the model. A photometric residual measures the motion since the reference frame. A geometric
// residual measures the pose relative to the model, which was built at estimated poses and has their drift.
//
// Between fusions, pose, velocity and gravity of the filter are relative to the model. When a frame is fused,
// the model takes over a share of its pose error. This share becomes an error of the model relative to the
// first camera (kModelPose).
//
// A rolling-shutter image is compensated by the estimated motion; the error of this motion remains as a
// distortion. The reference and the model contain such errors (kReferenceRate, kModelRate). Equal distortions
// in both images give no information on the motion. They give none on the read-out time either: a model of
// frames with the same motion and the same wrong read-out time has the same distortion (FusedReadout).
#pragma once

#include "core/estimator/filter/color_drift.hpp"
#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::filter {

/// Transports a pose error between two rigidly connected poses: tangents of T_world_imu (right rotation in
/// rad, world position in m).
[[nodiscard]] Matrix6d pose_transport(const SE3& to, const SE3& from);

/// Transports the rates of a FusedReadout by the matrix of pose_transport().
[[nodiscard]] FusedReadout transported(const Matrix6d& transport, const FusedReadout& readout);

/// Two poses (12) and the read-out errors (16).
inline constexpr int kMeasuredSize = 2 * kPoseSize + kReadoutSize;

/// The matrix B of the linear combinations B d that images measure:
/// - rows 0-5: pose against the reference frame; rows 6-11: pose against the model (tangents of the pose),
/// - rows 12-14: read-out of colour, read-out of depth, delay of depth,
/// - row 15: zero (the affine term of ReadoutVector),
/// - rows 16-21: rate of the pose minus the rate error of the reference; rows 22-27: minus that of the model.
[[nodiscard]] Eigen::Matrix<double, kMeasuredSize, kStateSize> measured_combinations(
    const FilterState& state);

/// Relation between the model and the frames that are fused into it.
struct ModelDrift {
  double share = 0;   ///< share of a frame's pose error that the model takes over, 0 to 1
  double factor = 1;  ///< ratio of the model's drift to that of independent errors (sigmas)
};

/// Motion and timing for which the images of a frame were compensated.
struct CompensatedReadout {
  Vector6d rate_left = Vector6d::Zero();  ///< part of the rate that was not compensated
  Vector6d rate = Vector6d::Zero();       ///< rate that was compensated
  Vector3d timing_s = Vector3d::Zero();   ///< timing errors that were assumed, as SensorErrors::timing_s()
};

/// State after the fusion of its frame: the model takes over a share of the pose error. The reference pose is
/// relative to the model, as the pose is, and moves with it.
[[nodiscard]] GaussianState fused_into_model(const GaussianState& state, const ModelDrift& drift,
                                             const CompensatedReadout& compensated = {});

/// State after the patches are cut from its frame: the pose becomes the reference pose.
[[nodiscard]] GaussianState cloned_as_reference(const GaussianState& state,
                                                const CompensatedReadout& compensated = {});

/// Adds the error of colour in a frame to the reference pose (color_drift.hpp).
[[nodiscard]] GaussianState with_reference_noise(GaussianState state, const ReferenceNoise& noise);

/// Adds the noise of the anchor's own image to the reference pose, with the covariance (information + W)^-1.
/// `information` (6x6, tangent of the pose) is that of one frame against an anchor; W limits directions that
/// colour does not observe to 0.01 rad and 0.1 m (sigmas).
[[nodiscard]] GaussianState with_anchor_noise(GaussianState state, const Matrix6d& information);

/// The state with the model errors of `there`, taken at the reference pose of that state.
[[nodiscard]] GaussianState with_model_of(const GaussianState& state, const GaussianState& there);

/// The estimate in the frame of the first camera: the uncertainty of the model's pose is added to that of
/// pose, velocity and gravity direction.
[[nodiscard]] GaussianState in_first_camera_world(const GaussianState& state);

}  // namespace fusebench::filter
