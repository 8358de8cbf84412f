// Camera tracking: damped Gauss-Newton over the levels of a frame, coarse to fine (Kaehler et al. 2015).
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/image_gradient.hpp"
#include "core/baselines/infinitam/color_matching.hpp"
#include "core/baselines/infinitam/depth_matching.hpp"
#include "core/baselines/infinitam/model_view.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::infinitam {

/// The levels of a frame, finest first. Intensity levels are empty if colour is not used.
struct FrameLevels {
  std::vector<DepthImage> depth_m;
  std::vector<Image<float>> intensity;
  std::vector<Gradient> gradient;
};
[[nodiscard]] FrameLevels levels_of(const RgbdFrame& frame, const config::InfinitamConfig& config);

/// Reference of the alignment.
struct TrackingTarget {
  const ModelView& view;      ///< rendered at the last camera pose
  const FrameLevels* before;  ///< last fused frame, at the pose of the view; may be nullptr
  bool by_weight = false;     ///< weights surfaces by their model weight
};

struct TrackedPose {
  SE3 T_world_camera;
  double inlier_share = 0;  ///< share of the measured pixels of the finest level that have a match
};

class PoseTracker {
 public:
  PoseTracker(const config::InfinitamConfig& config, const config::DepthConfig& depth,
              const PinholeCamera& camera, const Workers& workers);

  [[nodiscard]] TrackedPose track(const FrameLevels& frame, const SE3& T_world_start,
                                  const TrackingTarget& target) const;

 private:
  struct Level;
  struct Descent;
  [[nodiscard]] Level level(int number) const;
  [[nodiscard]] Descent descend(const FrameLevels& frame, const Level& level, const SE3& T_world_start,
                                const TrackingTarget& target) const;
  [[nodiscard]] PoseSums evaluate(const FrameLevels& frame, const Level& level, const SE3& T_world_camera,
                                  const TrackingTarget& target, double& depth_pixels) const;
  [[nodiscard]] bool is_small(const Vector6d& step) const;

  const config::InfinitamConfig& config_;
  const config::DepthConfig& depth_;
  PinholeCamera camera_;
  const Workers& workers_;
};

}  // namespace fusebench::baselines::infinitam
