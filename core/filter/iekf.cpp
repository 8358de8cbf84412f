#include "core/filter/iekf.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace fusebench::filter {

namespace {

/// One iterate: y, the chart coordinates d = P B^T y, the state there, and the hypothesis of reference and
/// model pose.
struct Iterate {
  MeasuredVector y = MeasuredVector::Zero();
  StateVector delta = StateVector::Zero();
  MeasuredVector measured = MeasuredVector::Zero();  ///< B d
  TangentVector tangents = TangentVector::Zero();    ///< of the poses, at the prior's pose
  FilterState state;
  PoseHypothesis poses;

  /// Since the images were prepared by the prior's.
  [[nodiscard]] Vector3d timing_s() const { return measured.tail<kTimingSize>(); }
};

/// Tangents of the two poses at the prior: the reference pose was corrected by an earlier update of the same
/// patches.
TangentVector known_tangents(const FilterState& prior) {
  TangentVector known = TangentVector::Zero();
  known.head<kPoseSize>() =
      -pose_transport(prior.T_world_imu, prior.T_world_imu_reference) * prior.reference_offset;
  return known;
}

class Update {
 public:
  Update(const GaussianState& prior, PoseMeasurement& measurement, const config::IekfConfig& config)
      : prior_(prior),
        measurement_(measurement),
        config_(config),
        combinations_(measured_combinations(prior.mean)),
        gain_columns_(prior.covariance * combinations_.transpose()),
        measured_covariance_(combinations_ * gain_columns_) {}

  IekfResult run(const MeasuredVector& start, SensorConstants constants) {
    IekfResult result;
    Iterate now = at(start);
    MeasurementQuadratic quadratic;
    const int stages = measurement_.stages();
    for (int stage = 0; stage < stages; ++stage) {
      const bool last = stage + 1 == stages;
      // Coarse stages only bring the estimate into the basin; at least one iteration is left for the finest
      // stage.
      const int budget = last ? config_.max_iterations - result.iterations
                              : std::min(config_.coarse_iterations,
                                         config_.max_iterations - result.iterations - (stages - 1 - stage));
      if (budget <= 0) continue;
      iterate_stage(stage, budget, last, now, quadratic, result);
    }
    result.map_cost_posterior = map_cost(now, quadratic.cost(now.timing_s()));
    result.posterior = posterior(now, quadratic, constants);
    result.measurement = at_posterior(now, quadratic);
    result.correction_by_model = correction_by_model(now, quadratic);
    result.timing = timing_at_posterior(now, quadratic.timing);
    result.solution = now.y;
    return result;
  }

 private:
  Iterate at(const MeasuredVector& y) const {
    Iterate iterate;
    iterate.y = y;
    iterate.delta = gain_columns_ * y;
    iterate.measured = measured_covariance_ * y;
    iterate.state = plus(prior_.mean, iterate.delta);
    iterate.tangents = iterate.measured.head<2 * kPoseSize>() + known_;
    iterate.poses = {pose_plus(prior_.mean.T_world_imu, iterate.tangents.head<kPoseSize>()),
                     pose_plus(prior_.mean.T_world_imu, iterate.tangents.tail<kPoseSize>())};
    return iterate;
  }

  double map_cost(const Iterate& iterate, double measurement_cost) const {
    const double prior_cost = config_.prior_in_every_iteration ? 0.5 * iterate.y.dot(iterate.measured) : 0.0;
    return prior_cost + measurement_cost;
  }

  /// Derivative of the poses' tangents (and of the timing) at the iterate by the chart coordinates at the
  /// prior.
  static MeasuredMatrix chart_jacobian(const Iterate& iterate) {
    MeasuredMatrix jacobian = MeasuredMatrix::Identity();
    jacobian.topLeftCorner<3, 3>() = so3_right_jacobian(iterate.tangents.head<3>());
    jacobian.block<3, 3>(kPoseSize, kPoseSize) = so3_right_jacobian(iterate.tangents.segment<3>(kPoseSize));
    return jacobian;
  }

  /// Information and gradient of the measurement in the chart at the prior.
  struct ChartQuadratic {
    MeasuredMatrix information = MeasuredMatrix::Zero();
    MeasuredVector gradient;
  };
  static ChartQuadratic in_chart(const MeasurementQuadratic& quadratic, const Iterate& now) {
    const MeasuredMatrix chart = chart_jacobian(now);
    const TimingQuadratic& timing = quadratic.timing;
    constexpr int kPoses = 2 * kPoseSize;
    ChartQuadratic result;
    MeasuredMatrix& information = result.information;
    information.topLeftCorner<kPoseSize, kPoseSize>() = quadratic.by_reference.information;
    information.block<kPoseSize, kPoseSize>(kPoseSize, kPoseSize) = quadratic.by_model.information;
    information.topRightCorner<kPoses, kTimingSize>() = timing.with_poses;
    information.bottomLeftCorner<kTimingSize, kPoses>() = timing.with_poses.transpose();
    information.bottomRightCorner<kTimingSize, kTimingSize>() = timing.information;
    result.gradient << quadratic.by_reference.gradient, quadratic.by_model.gradient, timing.gradient;
    result.gradient += information.rightCols<kTimingSize>() * now.timing_s();
    information = chart.transpose() * information * chart;
    result.gradient = chart.transpose() * result.gradient;
    return result;
  }

  void iterate_stage(int stage, int budget, bool last, Iterate& now, MeasurementQuadratic& quadratic,
                     IekfResult& result) {
    quadratic = measurement_.linearise(now.poses, stage, false);
    if (last) result.map_cost_prior = map_cost(now, quadratic.cost(now.timing_s()));
    result.converged = false;
    bool gated = false;
    for (int iteration = 0; iteration < budget && !result.converged; ++iteration) {
      const PoseHypothesis before = now.poses;
      if (!step(now, quadratic)) break;
      ++result.iterations;
      result.converged = is_small_step(before.T_world_imu_by_reference, now.poses.T_world_imu_by_reference) &&
                         is_small_step(before.T_world_imu_by_model, now.poses.T_world_imu_by_model);
      // The next stage linearises by itself where this one ends.
      if (!last && (result.converged || iteration + 1 == budget)) break;
      quadratic = measurement_.linearise(now.poses, stage, last);
      gated = last;
    }
    if (last && !gated) quadratic = measurement_.linearise(now.poses, stage, true);
  }

  bool is_small_step(const SE3& from, const SE3& to) const {
    return rotation_angle_rad(from.rotation, to.rotation) < config_.converged_rotation_rad &&
           (to.translation - from.translation).norm() < config_.converged_translation_m;
  }

  /// Both parts around the posterior: the one by reference was taken at another pose.
  static PoseQuadratic at_posterior(const Iterate& now, const MeasurementQuadratic& quadratic) {
    const Vector6d step = pose_minus(now.state.T_world_imu, now.poses.T_world_imu_by_reference);
    PoseQuadratic sum = quadratic.by_model;
    sum.add(quadratic.by_reference, 1.0);
    const TangentVector by_timing = quadratic.timing.with_poses * now.timing_s();
    sum.gradient += by_timing.head<kPoseSize>() + by_timing.tail<kPoseSize>();
    sum.cost +=
        step.dot(by_timing.head<kPoseSize>()) + quadratic.timing.cost(now.timing_s(), TangentVector::Zero());
    const Vector6d change = quadratic.by_reference.information * step;
    sum.cost += step.dot(quadratic.by_reference.gradient) + 0.5 * step.dot(change);
    sum.gradient += change;
    return sum;
  }

  /// The difference to the optimum of the same cost without its part by model.
  Vector6d correction_by_model(const Iterate& now, const MeasurementQuadratic& quadratic) const {
    ChartQuadratic others = in_chart(quadratic, now);
    others.information.middleRows<kPoseSize>(kPoseSize).setZero();
    others.information.middleCols<kPoseSize>(kPoseSize).setZero();
    others.gradient.segment<kPoseSize>(kPoseSize).setZero();
    const MeasuredMatrix system = MeasuredMatrix::Identity() + others.information * measured_covariance_;
    const MeasuredVector without =
        system.partialPivLu().solve(others.information * now.measured - others.gradient);
    return (now.measured - measured_covariance_ * without).segment<kPoseSize>(kPoseSize);
  }

  PoseTimingQuadratic timing_at_posterior(const Iterate& now, const TimingQuadratic& timing) const {
    const Vector6d step = pose_minus(now.state.T_world_imu, now.poses.T_world_imu_by_reference);
    const SensorErrors& prior = prior_.mean.sensors;
    PoseTimingQuadratic result;
    result.timing_s =
        Vector3d(prior.color_readout_s, prior.depth_readout_s, prior.depth_delay_s) + now.timing_s();
    const auto by_reference = timing.with_poses.topRows<kPoseSize>();
    result.with_pose = by_reference + timing.with_poses.bottomRows<kPoseSize>();
    result.information = timing.information;
    result.gradient = timing.gradient + by_reference.transpose() * step + timing.information * now.timing_s();
    return result;
  }

  /// Gauss-Newton step with halving until the MAP cost falls; false if it does not.
  bool step(Iterate& now, const MeasurementQuadratic& quadratic) {
    const ChartQuadratic local = in_chart(quadratic, now);
    // Stationarity of J in y: (I + Lambda S) y = Lambda S y_now - g, with S = B P B^T. Eq. 22 of the paper
    // takes each iterate for a new prediction: (I + Lambda S) (y - y_now) = -g.
    const MeasuredMatrix system = MeasuredMatrix::Identity() + local.information * measured_covariance_;
    MeasuredVector full;
    if (config_.prior_in_every_iteration) {
      full = system.partialPivLu().solve(local.information * now.measured - local.gradient) - now.y;
    } else {
      full = -system.partialPivLu().solve(local.gradient);
    }
    const TangentVector tangent_step =
        (chart_jacobian(now) * (measured_covariance_ * full)).head<2 * kPoseSize>();
    const double cost_now = map_cost(now, quadratic.cost(now.timing_s()));
    for (double fraction = 1.0; fraction > 0.05; fraction *= 0.5) {
      const Iterate trial = at(now.y + fraction * full);
      const double cost =
          map_cost(trial, measurement_.trial_cost(trial.poses, tangent_step, fraction) +
                              quadratic.timing.cost(trial.timing_s(), fraction * tangent_step));
      if (cost <= cost_now) {
        measurement_.accept();
        now = trial;
        return true;
      }
    }
    return false;
  }

  GaussianState posterior(const Iterate& now, const MeasurementQuadratic& quadratic,
                          SensorConstants constants) const {
    const MeasuredMatrix information = in_chart(quadratic, now).information;
    const MeasuredMatrix system = MeasuredMatrix::Identity() + information * measured_covariance_;
    const MeasuredMatrix reduction = system.partialPivLu().solve(information);
    StateMatrix in_chart_at_prior = prior_.covariance - gain_columns_ * reduction * gain_columns_.transpose();
    StateVector delta = now.delta;
    if (constants == SensorConstants::considered) {
      // Their gain is zero: the other states, and how they correlate with them, are updated all the same.
      delta.segment<kSensorSize>(kImuTimeOffset).setZero();
      in_chart_at_prior.block<kSensorSize, kSensorSize>(kImuTimeOffset, kImuTimeOffset) =
          prior_.covariance.block<kSensorSize, kSensorSize>(kImuTimeOffset, kImuTimeOffset);
    }
    const StateMatrix transport = chart_transport(prior_.mean, delta);
    return {plus(prior_.mean, delta), symmetrised(transport * in_chart_at_prior * transport.transpose())};
  }

  const GaussianState& prior_;
  PoseMeasurement& measurement_;
  const config::IekfConfig& config_;
  const Eigen::Matrix<double, kMeasuredSize, kStateSize> combinations_;  ///< B
  const Eigen::Matrix<double, kStateSize, kMeasuredSize> gain_columns_;  ///< P B^T
  const TangentVector known_ = known_tangents(prior_.mean);
  const MeasuredMatrix measured_covariance_;  ///< S = B P B^T
};

}  // namespace

Vector6d correction_in_imu(const IekfResult& update) {
  Vector6d correction = update.correction_by_model;
  correction.tail<3>() = update.posterior.mean.T_world_imu.rotation.conjugate() * correction.tail<3>();
  return correction;
}

MeasuredVector start_at(const GaussianState& prior, const SE3& T_world_imu) {
  // The covariance is singular where the prior knows a direction; 0.1 mrad and 0.1 mm will do for a start.
  constexpr double kTolerance = 1e-8;
  const auto combinations = measured_combinations(prior.mean);
  const MeasuredMatrix covariance = combinations * prior.covariance * combinations.transpose();
  const Vector6d tangent = pose_minus(T_world_imu, prior.mean.T_world_imu);
  MeasuredVector wanted = MeasuredVector::Zero();
  wanted.head<2 * kPoseSize>() -= known_tangents(prior.mean);
  wanted.head<kPoseSize>() += tangent;
  wanted.segment<kPoseSize>(kPoseSize) += tangent;
  const MeasuredMatrix system = covariance + kTolerance * MeasuredMatrix::Identity();
  return system.partialPivLu().solve(wanted);
}

IekfResult iekf_update(const GaussianState& prior, PoseMeasurement& measurement,
                       const config::IekfConfig& config, const MeasuredVector& start,
                       SensorConstants constants) {
  return Update(prior, measurement, config).run(start, constants);
}

}  // namespace fusebench::filter
