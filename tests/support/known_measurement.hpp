// A measurement of poses that are given.
#pragma once

#include "core/estimator/filter/iekf.hpp"

namespace fusebench {

/// Sees the motion since the reference frame, or the place against the model, with a given error.
class KnownMeasurement final : public filter::PoseMeasurement {
 public:
  KnownMeasurement(SE3 by_reference, SE3 by_model, double sigma_reference, double sigma_model)
      : by_reference_(by_reference),
        by_model_(by_model),
        reference_(information(sigma_reference)),
        model_(information(sigma_model)) {}
  filter::MeasurementQuadratic linearise(const filter::PoseHypothesis& poses, int, bool) override {
    return {quadratic(poses.T_world_imu_by_reference, by_reference_, reference_),
            quadratic(poses.T_world_imu_by_model, by_model_, model_)};
  }
  double trial_cost(const filter::PoseHypothesis& poses, const filter::TangentVector&, double) override {
    return linearise(poses, 0, false).cost();
  }
  void accept() override {}

 private:
  static double information(double sigma) { return sigma > 0 ? 1.0 / (sigma * sigma) : 0.0; }
  static filter::PoseQuadratic quadratic(const SE3& at, const SE3& measured, double weight) {
    const Vector6d error = pose_minus(at, measured);
    return {weight * Matrix6d::Identity(), weight * error, 0.5 * weight * error.squaredNorm()};
  }
  SE3 by_reference_, by_model_;
  double reference_, model_;
};

}  // namespace fusebench
