// Dependence of the patch residuals on the read-out of the images.
//
// A row that is read dt later than assumed shows the scene from the pose at that time. For a patch, an error
// dt of the timing displaces the pose by rate * dt. An error of the rate displaces it by (error * time
// between the instant of the frame and that of the row). Reference and model are displaced by their own
// errors, and only the difference is observable.
#pragma once

#include <array>

#include "core/estimator/filter/iekf.hpp"

namespace fusebench::measurement {

/// Timing and motion for which the images were compensated, relative to the prior: rates are tangents of the
/// pose by time (filter::pose_rate()) at the prior's pose. Zero if the read-out is not compensated; its
/// errors are not estimated then.
struct ReadoutMotion {
  double color_readout_s = 0;
  double depth_readout_s = 0;
  double depth_delay_s = 0;
  Vector6d rate = Vector6d::Zero();            ///< of the frame
  Vector6d reference_rate = Vector6d::Zero();  ///< of the reference, during its read-out
  filter::FusedReadout model = {};             ///< of the frames fused into the model
  // Timing errors (SensorErrors::timing_s()) that were assumed in the frame and in the reference.
  Vector3d supposed_s = Vector3d::Zero();
  double reference_color_readout_s = 0;
  /// Compensated read-out errors relative to the prior (filter::MeasurementQuadratic::compensated). Entry 3
  /// is -1, so that column 3 adds the displacements of reference and model by their assumed timing.
  filter::ReadoutVector compensated = filter::ReadoutVector::Zero();
  /// True if the rates differ by more than their noise. With equal rates, both frames have equal distortions.
  bool tells_color_readout = false;
};

/// Derivative of the pose tangent with respect to the read-out errors.
using PoseByReadout = Eigen::Matrix<double, filter::kPoseSize, filter::kReadoutSize>;

/// Sums over patches whose pose is displaced by the read-out errors: by w_0 M_0 + w_1 M_1, with two common
/// maps M and two weights w of each patch.
class DisplacedPatches {
 public:
  void add(const filter::PoseQuadratic& by_pose, const Vector2d& weights);
  /// variance: divisor of information and gradients.
  [[nodiscard]] filter::ReadoutQuadratic by_readout(const std::array<PoseByReadout, 2>& maps,
                                                    double variance) const;

 private:
  // Sums over the patches of information and gradient, weighted by one weight and by products of two.
  std::array<Matrix6d, 2> information_ = {Matrix6d::Zero(), Matrix6d::Zero()};
  std::array<Vector6d, 2> gradient_ = {Vector6d::Zero(), Vector6d::Zero()};
  std::array<Matrix6d, 3> products_ = {Matrix6d::Zero(), Matrix6d::Zero(), Matrix6d::Zero()};
};

/// Row positions of a patch in the frame and in its reference image, relative to the middle row, as shares of
/// the image height. They are the weights of the patch for colour.
struct PatchRows {
  double now = 0;
  double reference = 0;

  [[nodiscard]] Vector2d color_weights() const { return {now, reference}; }
  [[nodiscard]] Vector2d depth_weights() const { return {1.0, now}; }
};
[[nodiscard]] std::array<PoseByReadout, 2> color_displacement(const ReadoutMotion& motion);
[[nodiscard]] std::array<PoseByReadout, 2> depth_displacement(const ReadoutMotion& motion);

}  // namespace fusebench::measurement
