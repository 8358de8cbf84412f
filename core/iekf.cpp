#include "core/iekf.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace fusebench {

namespace {

/// One iterate: y, the chart coordinates d = P_(:,pose) y, and the state there.
struct Iterate {
  Vector6d y = Vector6d::Zero();
  StateVector delta = StateVector::Zero();
  FilterState state;
};

class Update {
 public:
  Update(const GaussianState& prior, PoseMeasurement& measurement, const IekfConfig& config)
      : prior_(prior),
        measurement_(measurement),
        config_(config),
        gain_columns_(prior.covariance.leftCols<kPoseSize>()),
        pose_covariance_(prior.covariance.topLeftCorner<kPoseSize, kPoseSize>()) {}

  IekfResult run(const Vector6d& start) {
    IekfResult result;
    Iterate now = at(start);
    PoseQuadratic quadratic;
    const int stages = measurement_.stages();
    for (int stage = 0; stage < stages; ++stage) {
      const bool last = stage + 1 == stages;
      // Coarse stages only bring the estimate into the basin; at least one iteration is left for the real
      // thing.
      const int budget = last ? config_.max_iterations - result.iterations
                              : std::min(config_.coarse_iterations,
                                         config_.max_iterations - result.iterations - (stages - 1 - stage));
      if (budget <= 0) continue;
      iterate_stage(stage, budget, last, now, quadratic, result);
    }
    result.map_cost_posterior = map_cost(now, quadratic.cost);
    result.posterior = posterior(now, quadratic);
    result.measurement = quadratic;
    return result;
  }

 private:
  Iterate at(const Vector6d& y) const {
    Iterate iterate;
    iterate.y = y;
    iterate.delta = gain_columns_ * y;
    iterate.state = plus(prior_.mean, iterate.delta);
    return iterate;
  }

  double map_cost(const Iterate& iterate, double measurement_cost) const {
    return 0.5 * iterate.y.dot(pose_covariance_ * iterate.y) + measurement_cost;
  }

  /// Derivative of the pose's tangent at the iterate by the chart coordinates at the prior.
  static Matrix6d chart_jacobian(const Iterate& iterate) {
    Matrix6d jacobian = Matrix6d::Identity();
    jacobian.topLeftCorner<3, 3>() = so3_right_jacobian(iterate.delta.segment<3>(kRotation));
    return jacobian;
  }

  void iterate_stage(int stage, int budget, bool last, Iterate& now, PoseQuadratic& quadratic,
                     IekfResult& result) {
    quadratic = measurement_.linearise(now.state.T_world_imu, stage, false);
    if (last) result.map_cost_prior = map_cost(now, quadratic.cost);
    result.converged = false;
    for (int iteration = 0; iteration < budget && !result.converged; ++iteration) {
      const Iterate before = now;
      if (!step(now, quadratic)) break;
      ++result.iterations;
      const double turned =
          rotation_angle_rad(before.state.T_world_imu.rotation, now.state.T_world_imu.rotation);
      const double moved = (now.state.T_world_imu.translation - before.state.T_world_imu.translation).norm();
      result.converged = turned < config_.converged_rotation_rad && moved < config_.converged_translation_m;
      quadratic = measurement_.linearise(now.state.T_world_imu, stage, last);
    }
  }

  /// Gauss-Newton step with halving until the MAP cost falls; false if it does not.
  bool step(Iterate& now, const PoseQuadratic& quadratic) {
    const Matrix6d chart = chart_jacobian(now);
    const Matrix6d information = chart.transpose() * quadratic.information * chart;
    const Vector6d gradient = chart.transpose() * quadratic.gradient;
    // Stationarity of J in y: (I + Lambda P) y = Lambda P y_now - g.
    const Matrix6d system = Matrix6d::Identity() + information * pose_covariance_;
    const Vector6d target = system.partialPivLu().solve(information * (pose_covariance_ * now.y) - gradient);
    const Vector6d full = target - now.y;
    const Vector6d tangent_step = chart * (pose_covariance_ * full);
    const double cost_now = map_cost(now, quadratic.cost);
    for (double fraction = 1.0; fraction > 0.05; fraction *= 0.5) {
      const Iterate trial = at(now.y + fraction * full);
      const double cost =
          map_cost(trial, measurement_.trial_cost(trial.state.T_world_imu, tangent_step, fraction));
      if (cost <= cost_now) {
        measurement_.accept();
        now = trial;
        return true;
      }
    }
    return false;
  }

  GaussianState posterior(const Iterate& now, const PoseQuadratic& quadratic) const {
    const Matrix6d chart = chart_jacobian(now);
    const Matrix6d information = chart.transpose() * quadratic.information * chart;
    const Matrix6d system = Matrix6d::Identity() + information * pose_covariance_;
    const Matrix6d reduction = system.partialPivLu().solve(information);
    const StateMatrix in_chart = prior_.covariance - gain_columns_ * reduction * gain_columns_.transpose();
    const StateMatrix transport = chart_transport(prior_.mean, now.delta);
    return {now.state, symmetrised(transport * in_chart * transport.transpose())};
  }

  const GaussianState& prior_;
  PoseMeasurement& measurement_;
  const IekfConfig& config_;
  const Eigen::Matrix<double, kStateSize, kPoseSize> gain_columns_;
  const Matrix6d pose_covariance_;
};

}  // namespace

IekfResult iekf_update(const GaussianState& prior, PoseMeasurement& measurement, const IekfConfig& config,
                       const Vector6d& start) {
  return Update(prior, measurement, config).run(start);
}

}  // namespace fusebench
