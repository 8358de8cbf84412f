// How what the patches measure depends on the read-out of the images. A row that was read later than supposed
// shows the scene from where the camera was then: for a patch, an error of the timing displaces the pose by
// the motion during that time, and an error of the motion displaces it by what adds up between the frame's
// instant and the row's. What the patch is compared with, reference or model, was displaced likewise by
// errors of its own: only the difference shows.
#pragma once

#include <array>

#include "core/filter/iekf.hpp"

namespace fusebench::measurement {

/// What the images were prepared for: when their rows were read, and how the camera moved meanwhile, as the
/// tangent of its pose by time (filter::pose_rate()), around the prior's pose. Zero where the read-out is not
/// undone: then nothing is learnt of it.
struct ReadoutMotion {
  double color_readout_s = 0;
  double depth_readout_s = 0;
  double depth_delay_s = 0;
  Vector6d rate = Vector6d::Zero();            ///< in the frame
  Vector6d reference_rate = Vector6d::Zero();  ///< when the reference was read
  filter::FusedReadout model = {};             ///< of the frames in the model
  // Errors of the timing that were supposed (SensorErrors::timing_s()): in the frame, in the reference.
  Vector3d supposed_s = Vector3d::Zero();
  double reference_color_readout_s = 0;
  /// By how much timing and rate differ from the prior's (filter::MeasurementQuadratic::undone); between
  /// them -1, for which the displacements of reference and model by another timing count once.
  filter::ReadoutVector undone = filter::ReadoutVector::Zero();
  /// The rates differ by more than their noise. Two frames are distorted alike unless they do.
  bool tells_color_readout = false;
};

/// Tangent of the pose by the errors of the read-out.
using PoseByReadout = Eigen::Matrix<double, filter::kPoseSize, filter::kReadoutSize>;

/// Measurements by patches of which the errors of the read-out displace the pose, each by two known maps with
/// weights of its own.
class DisplacedPatches {
 public:
  void add(const filter::PoseQuadratic& by_pose, const Vector2d& weights);
  /// variance: what information and gradients are divided by.
  [[nodiscard]] filter::ReadoutQuadratic by_readout(const std::array<PoseByReadout, 2>& maps,
                                                    double variance) const;

 private:
  // Sums over the patches: of information and gradient, by one weight and by the products of two.
  std::array<Matrix6d, 2> information_ = {Matrix6d::Zero(), Matrix6d::Zero()};
  std::array<Vector6d, 2> gradient_ = {Vector6d::Zero(), Vector6d::Zero()};
  std::array<Matrix6d, 3> products_ = {Matrix6d::Zero(), Matrix6d::Zero(), Matrix6d::Zero()};
};

/// Where a patch is in the frame and in the image that it was cut from: rows from the middle one, as shares
/// of the image's height. By colour, a patch's weights are these.
struct PatchRows {
  double now = 0;
  double reference = 0;

  [[nodiscard]] Vector2d color_weights() const { return {now, reference}; }
  [[nodiscard]] Vector2d depth_weights() const { return {1.0, now}; }
};
[[nodiscard]] std::array<PoseByReadout, 2> color_displacement(const ReadoutMotion& motion);
[[nodiscard]] std::array<PoseByReadout, 2> depth_displacement(const ReadoutMotion& motion);

}  // namespace fusebench::measurement
