// The brightness of a patch in a frame: a gain and an offset that are estimated along with the pose.
#pragma once

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/iekf.hpp"

namespace fusebench::measurement {

/// Gain and offset (grey levels), eliminated from each step (Schur complement) and carried along. The normal
/// equations are of the last linearisation.
struct PatchBrightness {
  /// Sets `trial` to a fraction of the step that belongs to a step of the pose.
  void try_step(const Eigen::Matrix<double, filter::kPoseSize, 1>& pose_step, double fraction);

  Vector2d value{1.0, 0.0};
  Vector2d trial{1.0, 0.0};
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Vector2d gradient = Vector2d::Zero();
  Eigen::Matrix<double, 2, filter::kPoseSize> by_pose = Eigen::Matrix<double, 2, filter::kPoseSize>::Zero();
};

/// No change of brightness is expected, up to the sigmas of the configuration; a sigma of zero fixes the
/// value.
class BrightnessPrior {
 public:
  explicit BrightnessPrior(const config::PhotometricConfig& config);

  [[nodiscard]] double cost(const Vector2d& gain_and_offset) const;
  /// Adds the prior to the normal equations of brightness and eliminates brightness from those of the pose.
  void eliminate(PatchBrightness& light, filter::PoseQuadratic& photometric) const;

 private:
  Vector2d information_;  // of gain and offset
};

}  // namespace fusebench::measurement
