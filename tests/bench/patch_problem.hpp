// What one linearisation of the patches works on: a frame of the room, and patches cut from that very frame.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "core/depth_gates.hpp"
#include "core/patch_measurement.hpp"
#include "tests/bench/bench_scene.hpp"

namespace fusebench::testing {

/// Refers to itself: stays where it was made.
struct PatchProblem {
  PatchProblem(const BenchScene& scene_in, const Workers& workers)
      : scene(scene_in),
        pyramid(build_pyramid(scene.frame.grey, scene.config.patches.levels)),
        depth_m(gate_depth(scene.frame.depth_m, scene.config.depth)),
        patches(refresh_patches(reference(), scene.model, {}, scene.config, workers)) {}
  PatchProblem(const PatchProblem&) = delete;
  PatchProblem& operator=(const PatchProblem&) = delete;

  [[nodiscard]] ReferenceFrame reference() const {
    return {pyramid, depth_m, scene.camera, scene.T_world_camera};
  }
  /// Distance of a pose from the one that the frame was rendered at.
  [[nodiscard]] double error_m(const SE3& T_world_camera) const {
    return (T_world_camera.translation - scene.T_world_camera.translation).norm();
  }

  /// The Gauss-Newton step from the start, where it leads, and its tangents.
  struct Step {
    SE3 T_world_camera;
    MeasuredVector tangents;
  };
  [[nodiscard]] Step step_by(const MeasurementQuadratic& at_start) const {
    PoseQuadratic quadratic = at_start.by_reference;
    quadratic.add(at_start.by_model, 1.0);
    const Vector6d step = -quadratic.information.ldlt().solve(quadratic.gradient);
    Step result{{start.rotation * so3_exp(step.head<3>()), start.translation + step.tail<3>()}, {}};
    result.tangents << step, step;
    return result;
  }

  const BenchScene& scene;
  std::vector<GreyImage> pyramid;
  DepthImage depth_m;
  std::vector<Patch> patches;
  ObservedFrame observed{pyramid, depth_m};
  SensorRig rig{.camera = scene.camera, .timing = {}, .T_imu_camera = {}, .imu_noise = {}};
  /// Off by what a prediction is off.
  SE3 start{scene.T_world_camera.rotation * so3_exp({0.002, -0.001, 0.001}),
            scene.T_world_camera.translation + Vector3d(0.003, 0.002, -0.002)};
};

}  // namespace fusebench::testing
