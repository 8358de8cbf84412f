// What the kernels of tracking work on: a frame, and patches cut from the view that was fused before it (in
// the room from that very frame).
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "core/config/config.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/support/gated_depth.hpp"

namespace fusebench::testing {

/// Refers to itself: stays where it was made.
struct PatchProblem {
  /// max_count: of patches.
  PatchProblem(const BenchScene& scene_in, const Workers& workers,
               int max_count = config::PatchConfig{}.max_count)
      : scene(scene_in),
        config(config_of(scene_in, max_count)),
        reference_pyramid(build_pyramid(scene.views.back().grey, config.patches.levels)),
        reference_depth_m(gated_depth(scene.views.back().depth_m, config.depth)),
        pyramid(build_pyramid(scene.frame.grey, config.patches.levels)),
        depth_m(gated_depth(scene.frame.depth_m, config.depth)),
        patches(patches::refresh_patches(reference(), scene.model, {},
                                         {config.patches, config.depth, config.terms.deformation}, workers)) {
    if (scene.kind == SceneKind::recording) target = best_fit(workers);
  }
  PatchProblem(const PatchProblem&) = delete;
  PatchProblem& operator=(const PatchProblem&) = delete;

  [[nodiscard]] patches::ReferenceFrame reference() const {
    return {reference_pyramid, reference_depth_m, scene.camera, scene.views.back().T_world_camera};
  }
  /// The patches in the frame.
  [[nodiscard]] std::unique_ptr<measurement::PatchMeasurement> measurement(const Workers& workers) const {
    auto measurement = std::make_unique<measurement::PatchMeasurement>(config, rig, workers);
    measurement->observe(observed, patches, {});
    return measurement;
  }
  /// Distance of a pose from where the patches fit.
  [[nodiscard]] double error_m(const SE3& T_world_camera) const {
    return (T_world_camera.translation - target.translation).norm();
  }
  /// Off by what a prediction is off.
  [[nodiscard]] SE3 start() const {
    return {target.rotation * so3_exp({0.002, -0.001, 0.001}),
            target.translation + Vector3d(0.003, 0.002, -0.002)};
  }

  /// The Gauss-Newton step from a pose, where it leads, and its tangents.
  struct Step {
    SE3 T_world_camera;
    filter::TangentVector tangents;
  };
  [[nodiscard]] static Step step_by(const filter::MeasurementQuadratic& at_pose, const SE3& T_world_camera) {
    filter::PoseQuadratic quadratic = at_pose.by_reference;
    quadratic.add(at_pose.by_model, 1.0);
    const Vector6d step = -quadratic.information.ldlt().solve(quadratic.gradient);
    Step result{pose_plus(T_world_camera, step), {}};
    result.tangents << step, step;
    return result;
  }

  /// What is known before the frame's update.
  [[nodiscard]] filter::GaussianState prior() const {
    filter::GaussianState prior;
    prior.mean.T_world_imu = start();
    prior.mean.T_world_imu_reference = scene.views.back().T_world_camera;
    prior.covariance.diagonal().setConstant(1e-4);
    // What the patches were cut from, and the model, are known to fractions of a millimetre: else the update
    // would move these instead, where colour and depth do not agree.
    prior.covariance.diagonal().segment<2 * filter::kPoseSize>(filter::kReferencePose).setConstant(1e-7);
    return prior;
  }
  /// A frame's update, from its patches on.
  [[nodiscard]] filter::IekfResult update(const filter::GaussianState& prior, const Workers& workers) const {
    const auto in_frame = measurement(workers);
    measurement::PatchMeasurement& measured = *in_frame;
    return filter::iekf_update(prior, measured, config.iekf);
  }
  [[nodiscard]] bool is_updated(const filter::IekfResult& result) const {
    return result.posterior.covariance.allFinite() &&
           error_m(result.posterior.mean.T_world_imu) < 0.5 * error_m(start());
  }

  const BenchScene& scene;
  config::Config config;
  std::vector<GreyImage> reference_pyramid;
  DepthImage reference_depth_m;
  std::vector<GreyImage> pyramid;
  DepthImage depth_m;
  SensorRig rig{.camera = scene.camera, .timing = {}, .T_imu_camera = {}, .imu_noise = {}};
  measurement::ObservedFrame observed{pyramid, depth_m};
  std::vector<patches::Patch> patches;
  SE3 target = scene.T_world_camera;  ///< where the patches fit

 private:
  /// Iterations do not end by themselves: a last digit must not decide how many there are.
  static config::Config config_of(const BenchScene& scene, int max_count) {
    config::Config config;
    config.patches = scene.config.patches;
    config.depth = scene.config.depth;
    config.tsdf = scene.config.tsdf;
    config.patches.max_count = max_count;
    config.iekf.converged_rotation_rad = 0;
    config.iekf.converged_translation_m = 0;
    config.iekf.max_iterations = 6;
    return config;
  }

  /// The true poses of a recording are off by some millimetres: the pose to be found is the one at which a
  /// dozen plain Gauss-Newton steps end, and that is where the truth is, as far as it is known.
  [[nodiscard]] SE3 best_fit(const Workers& workers) const {
    const auto in_frame = measurement(workers);
    measurement::PatchMeasurement& measured = *in_frame;
    SE3 pose = scene.T_world_camera;
    double last_step = 1;
    for (int i = 0; i < 12; ++i) {
      const Step step = step_by(measured.linearise({pose, pose}, measured.stages() - 1, true), pose);
      static_cast<void>(measured.trial_cost({step.T_world_camera, step.T_world_camera}, step.tangents, 1.0));
      measured.accept();
      pose = step.T_world_camera;
      last_step = step.tangents.norm();
    }
    check(last_step < 1e-3 && (pose.translation - scene.T_world_camera.translation).norm() < 0.05,
          "the patches of the recording fit near its ground truth");
    return pose;
  }
};

/// The cost at the pose of a linearisation is the one that it had, and its slope there, by differences of
/// costs with everything else fixed, is the gradient.
inline bool is_slope_of_cost(measurement::PatchMeasurement& measurement,
                             const filter::MeasurementQuadratic& parts, const SE3& T_world_camera) {
  constexpr double kSmall = 1e-4;  // rad, m: some hundredths of a pixel
  const auto cost_at = [&](const Vector6d& step) {
    const SE3 pose = pose_plus(T_world_camera, step);
    filter::TangentVector tangents;
    tangents << step, step;
    return measurement.trial_cost({pose, pose}, tangents, 1.0);
  };
  const double cost =
      measurement.trial_cost({T_world_camera, T_world_camera}, filter::TangentVector::Zero(), 0.0);
  if (!(std::abs(cost - parts.cost()) < 1e-3 * cost)) return false;
  const Vector6d gradient = parts.by_reference.gradient + parts.by_model.gradient;
  Vector6d slope;
  for (int axis = 0; axis < filter::kPoseSize; ++axis) {
    const Vector6d step = kSmall * Vector6d::Unit(axis);
    slope[axis] = (cost_at(step) - cost_at(-step)) / (2 * kSmall);
  }
  const auto is_near = [](const Vector3d& a, const Vector3d& b) { return (a - b).norm() < 0.05 * b.norm(); };
  return is_near(slope.head<3>(), gradient.head<3>()) && is_near(slope.tail<3>(), gradient.tail<3>());
}

}  // namespace fusebench::testing
