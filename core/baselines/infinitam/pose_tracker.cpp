#include "core/baselines/infinitam/pose_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/solvers.hpp"
#include "core/baselines/infinitam/depth_pyramid.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::infinitam {

namespace {

constexpr double kFewestPixels = 100;  // fewer matches are insufficient

int level_count(const config::InfinitamConfig& config) { return config.rotation_levels + config.full_levels; }

/// Step of the damped normal equations; zero if they are singular.
Vector6d damped_step(const PoseSums& sums, double damping, bool rotation_only) {
  Matrix6d damped = sums.information;
  damped.diagonal() *= 1 + damping;
  Vector6d step = Vector6d::Zero();
  if (rotation_only) {
    const Eigen::LLT<Matrix3d> factor(damped.topLeftCorner<3, 3>());
    if (factor.info() == Eigen::Success) step.head<3>() = factor.solve(sums.descent.head<3>());
  } else {
    const Eigen::LLT<Matrix6d> factor(damped);
    if (factor.info() == Eigen::Success) step = factor.solve(sums.descent);
  }
  return step.allFinite() ? step : Vector6d::Zero();
}

/// Camera pose after a motion of the world points.
SE3 moved(const SE3& T_world_camera, const Vector6d& step) {
  return SE3{so3_exp(step.head<3>()), step.tail<3>()} * T_world_camera;
}

}  // namespace

/// One level of the schedule.
struct PoseTracker::Level {
  int number = 0;
  bool rotation_only = false;
  int iterations = 0;
  double gate = 0;
  double color_gate = 0;
  PinholeCamera camera;
};

/// Result of a level.
struct PoseTracker::Descent {
  SE3 T_world_camera;
  double depth_pixels = 0;  ///< with a match, at the last accepted pose
};

FrameLevels levels_of(const RgbdFrame& frame, const config::InfinitamConfig& config) {
  FrameLevels levels{depth_pyramid(frame.depth_m, level_count(config)), {}, {}};
  if (!config.use_color) return levels;
  levels.intensity = intensity_pyramid(frame.grey, level_count(config));
  for (const Image<float>& image : levels.intensity) levels.gradient.push_back(gradient_of(image));
  return levels;
}

PoseTracker::PoseTracker(const config::InfinitamConfig& config, const config::DepthConfig& depth,
                         const PinholeCamera& camera, const Workers& workers)
    : config_(config), depth_(depth), camera_(camera), workers_(workers) {}

PoseTracker::Level PoseTracker::level(int number) const {
  const int last = level_count(config_) - 1;
  const double coarseness = last > 0 ? static_cast<double>(number) / last : 0.0;
  const auto between = [&](double fine, double coarse) { return fine + coarseness * (coarse - fine); };
  Level level;
  level.number = number;
  level.rotation_only = number >= config_.full_levels;
  level.iterations =
      static_cast<int>(std::lround(between(config_.iterations_fine, config_.iterations_coarse)));
  level.gate = between(config_.gate_fine, config_.gate_coarse);
  level.color_gate = between(config_.color_gate_fine, config_.color_gate_coarse);
  level.camera = camera_of_level(camera_, number);
  return level;
}

PoseSums PoseTracker::evaluate(const FrameLevels& frame, const Level& level, const SE3& T_world_camera,
                               const TrackingTarget& target, double& depth_pixels) const {
  const bool extended = config_.tracker == config::InfinitamTracker::extended;
  const auto number = static_cast<std::size_t>(level.number);
  DepthMatching matching;
  matching.max_squared_distance_m2 = extended ? config_.gate_factor * level.gate : level.gate;
  matching.huber_m = extended ? level.gate : 0;
  matching.near_m = depth_.min_m;
  matching.far_m = depth_.max_m;
  matching.by_weight = target.by_weight;
  matching.weight_to_skip = config_.frames_to_skip;
  matching.weight_to_count = config_.frames_to_weight;
  const PoseSums depth =
      match_depth(frame.depth_m[number], level.camera, T_world_camera, target.view, matching, workers_);
  depth_pixels = depth.pixels;
  PoseSums sums;
  if (depth.pixels > kFewestPixels) sums = depth.mean();
  if (!extended || !config_.use_color || target.before == nullptr) return sums;
  const Gradient& gradient = target.before->gradient[number];
  const ColorLevel colors{&frame.depth_m[number],
                          &frame.intensity[number],
                          &target.before->intensity[number],
                          &gradient.dx,
                          &gradient.dy,
                          level.camera};
  const ColorMatching color{level.color_gate, config_.gate_factor * level.color_gate,
                            config_.min_color_gradient, depth_.min_m, depth_.max_m};
  PoseSums intensity = match_color(colors, T_world_camera, target.view.T_world_camera, color, workers_);
  if (intensity.pixels <= kFewestPixels) return sums;
  // As in the published program: the weight enters the gradient once and the information twice.
  intensity = intensity.mean();
  intensity.descent *= config_.color_weight;
  intensity.information *= config_.color_weight * config_.color_weight;
  return sums += intensity;
}

/// Largest component (extended), or length / 6 (icp), as in the published program.
bool PoseTracker::is_small(const Vector6d& step) const {
  if (config_.tracker == config::InfinitamTracker::extended)
    return step.cwiseAbs().maxCoeff() <= config_.min_step;
  return step.norm() / 6 < config_.min_step;
}

PoseTracker::Descent PoseTracker::descend(const FrameLevels& frame, const Level& level,
                                          const SE3& T_world_start, const TrackingTarget& target) const {
  Descent accepted{T_world_start, 0};
  SE3 T_world_camera = T_world_start;
  PoseSums sums;
  sums.cost = std::numeric_limits<double>::infinity();
  double damping = 1;
  for (int iteration = 0; iteration < level.iterations; ++iteration) {
    double depth_pixels = 0;
    const PoseSums here = evaluate(frame, level, T_world_camera, target, depth_pixels);
    if (here.pixels > 0 && here.cost < sums.cost) {
      accepted = {T_world_camera, depth_pixels};
      sums = here;
      damping /= 10;
    } else {
      T_world_camera = accepted.T_world_camera;
      damping *= 10;
    }
    if (!std::isfinite(sums.cost)) break;  // no matches at the start
    const Vector6d step = damped_step(sums, damping, level.rotation_only);
    T_world_camera = moved(T_world_camera, step);
    if (is_small(step)) break;
  }
  // The last step is accepted without an evaluation of its cost, as in the published program.
  accepted.T_world_camera = T_world_camera;
  return accepted;
}

TrackedPose PoseTracker::track(const FrameLevels& frame, const SE3& T_world_start,
                               const TrackingTarget& target) const {
  Descent descent{T_world_start, 0};
  for (int number = level_count(config_) - 1; number >= 0; --number)
    descent = descend(frame, level(number), descent.T_world_camera, target);
  const auto measured =
      std::ranges::count_if(frame.depth_m.front().data, [](float depth_m) { return depth_m > 0; });
  return {descent.T_world_camera, measured > 0 ? descent.depth_pixels / static_cast<double>(measured) : 0.0};
}

}  // namespace fusebench::baselines::infinitam
