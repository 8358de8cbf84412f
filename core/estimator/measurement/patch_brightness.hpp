// The brightness of a patch in a frame: a gain and an offset, estimated together with the pose.
#pragma once

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// Gain and offset (grey levels). They are eliminated from each step by the Schur complement and updated
/// afterwards. The normal equations are those of the last linearisation.
struct PatchBrightness {
  /// Sets `trial` to `fraction` of the brightness step that corresponds to the pose step.
  void try_step(const Eigen::Matrix<double, filter::kPoseSize, 1>& pose_step, double fraction);

  Vector2d value{1.0, 0.0};
  Vector2d trial{1.0, 0.0};
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Vector2d gradient = Vector2d::Zero();
  Eigen::Matrix<double, 2, filter::kPoseSize> by_pose = Eigen::Matrix<double, 2, filter::kPoseSize>::Zero();
};

/// Prior of the brightness: the common gain of all patches and zero offset, with the sigmas of the
/// configuration plus half of the common change. A sigma of zero fixes the value.
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

/// Common gain of a frame: median over the patches of (mean grey level in the frame) / (mean grey level in
/// the reference). 1 if fewer than five patches have visible pixels with enough light. `level`: a warped
/// coarse level, whose means are insensitive to position errors.
[[nodiscard]] double common_gain(const patches::LevelLanes& level, const GreyImage& image);

}  // namespace fusebench::measurement
