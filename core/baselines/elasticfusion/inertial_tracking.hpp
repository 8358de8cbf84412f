// Inertial term of tracking (Laidlow et al., "Dense RGB-D-Inertial SLAM with Map Deformations", IROS 2017):
// predicts pose, velocity, biases and gravity by the inertial samples, adds the prediction as a prior to the
// image equations, and corrects the state by the result.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/baselines/elasticfusion/tracking/camera_tracker.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::baselines::elasticfusion {

class InertialTracking {
 public:
  /// samples: of the whole recording, sorted. All arguments must outlive the object.
  InertialTracking(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> samples)
      : config_(config), rig_(rig), samples_(samples) {}

  /// Starts at the first frame, whose camera frame is the world. Error data_corrupt: no samples around it.
  [[nodiscard]] Result<void> start(std::int64_t capture_ns);

  /// Predicts the state of the next frame. Error data_corrupt: samples do not cover the interval.
  [[nodiscard]] Result<void> predict(std::int64_t capture_ns);
  [[nodiscard]] SE3 T_world_camera() const { return state_.mean.T_world_imu * rig_.T_imu_camera; }

  /// Prior of the predicted pose, weighted by its covariance. Valid until the state changes.
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

  /// Corrects the state by the tracked pose and the image equations there.
  void correct(const SE3& T_world_view, const SE3& T_view_camera, const tracking::ImageEquations& images);

  /// Moves the state to a pose given by a loop; velocity and gravity rotate with it.
  void move_to(const SE3& T_world_camera);

 private:
  const config::Config& config_;
  const SensorRig& rig_;
  std::span<const ImuSample> samples_;
  filter::GaussianState state_;
  std::int64_t capture_ns_ = 0;
};

}  // namespace fusebench::baselines::elasticfusion
