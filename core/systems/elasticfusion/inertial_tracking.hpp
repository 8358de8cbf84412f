// What an IMU says of the camera's motion, for tracking (Laidlow et al., "Dense RGB-D-Inertial SLAM with Map
// Deformations", IROS 2017): pose, velocity, biases and gravity of the last frame are carried to the next one
// by the inertial samples between, weigh there against the images, and are corrected by what comes out.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/systems/elasticfusion/tracking/camera_tracker.hpp"

namespace fusebench::systems::elasticfusion {

class InertialTracking {
 public:
  /// The samples are of the whole recording, sorted; they and the rest must outlive it.
  InertialTracking(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> samples)
      : config_(config), rig_(rig), samples_(samples) {}

  /// The first frame, whose camera is the world. Error data_corrupt: no samples around it.
  [[nodiscard]] Result<void> start(std::int64_t capture_ns);

  /// Carries the state to the next frame. Error data_corrupt: samples do not cover the interval.
  [[nodiscard]] Result<void> predict(std::int64_t capture_ns);
  [[nodiscard]] SE3 T_world_camera() const { return state_.mean.T_world_imu * rig_.T_imu_camera; }

  /// How the pose of the prediction weighs against images, by its covariance. Valid until the state changes.
  class Term final : public tracking::PoseTerm {
   public:
    Term(const InertialTracking& inertial, const SE3& T_world_view);
    [[nodiscard]] Vector6d step(const SE3& T_view_camera,
                                const tracking::ImageEquations& images) const override;

   private:
    SE3 T_world_imu_;  ///< predicted
    SE3 T_world_view_;
    SE3 T_imu_camera_;
    Matrix6d prediction_information_;  ///< of errors of the predicted pose
  };

  /// After tracking with the term: the pose that came out, and what images said there.
  void correct(const SE3& T_world_view, const SE3& T_view_camera, const tracking::ImageEquations& images);

  /// The camera is elsewhere, as a loop says: velocity and gravity turn with it.
  void move_to(const SE3& T_world_camera);

 private:
  const config::Config& config_;
  const SensorRig& rig_;
  std::span<const ImuSample> samples_;
  filter::GaussianState state_;
  std::int64_t capture_ns_ = 0;
};

}  // namespace fusebench::systems::elasticfusion
