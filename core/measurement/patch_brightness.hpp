// The brightness of a patch in a frame: a gain and an offset that are estimated along with the pose.
#pragma once

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/iekf.hpp"
#include "core/patches/patch_lanes.hpp"

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

/// Brightness has the gain that all patches have in common and no offset, up to the sigmas of the
/// configuration and half of the common change; a sigma of zero fixes the value.
class BrightnessPrior {
 public:
  explicit BrightnessPrior(const config::PhotometricConfig& config, double common_gain = 1);

  [[nodiscard]] Vector2d mean() const { return {common_gain_, 0}; }

  [[nodiscard]] double cost(const Vector2d& gain_and_offset) const;
  /// Adds the prior to the normal equations of brightness and eliminates brightness from those of the pose.
  void eliminate(PatchBrightness& light, filter::PoseQuadratic& photometric) const;

 private:
  Vector2d information_;  // of gain and offset
  double common_gain_;
};

/// The gain of a frame against the patches: the median over the patches of the ratio of their mean grey
/// levels there to those of the reference. 1 if fewer than five patches have visible pixels of some light.
/// `level`: coarse, so that the means hardly depend on where exactly the patches are; already warped.
[[nodiscard]] double common_gain(const patches::LevelLanes& level, const GreyImage& image);

}  // namespace fusebench::measurement
