#include "core/estimator/filter/iekf.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

#include "core/config/groups/filter_config.hpp"

namespace fusebench::filter {

namespace {

/// One iterate: y, the chart coordinates d = P B^T y, the state there, and the hypothesis of reference and
/// model pose.
struct Iterate {
  MeasuredVector y = MeasuredVector::Zero();
  StateVector delta = StateVector::Zero();
  MeasuredVector measured = MeasuredVector::Zero();  ///< B d
  TangentVector tangents = TangentVector::Zero();    ///< of both poses, at the prior's pose
  FilterState state;
  PoseHypothesis poses;

  ReadoutVector readout = ReadoutVector::Zero();  ///< read-out errors relative to the prior
};

/// B x at the prior: the reference may have been corrected by an earlier update of the same patches, and the
/// model has an offset.
MeasuredVector known_at(const FilterState& prior) {
  const Matrix6d carried = pose_transport(prior.T_world_imu, prior.T_world_imu_reference);
  MeasuredVector known = MeasuredVector::Zero();
  known.head<kPoseSize>() = -carried * prior.reference_offset;
  known.segment<kPoseSize>(kMeasuredSize - 2 * kPoseSize) = -carried * prior.reference_rate_offset;
  known.tail<kPoseSize>() = -carried * prior.model_rate_offset;
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
      // The coarse stages only need to reach the basin of convergence; at least one iteration is reserved for
      // the finest stage.
      const int budget = last ? config_.max_iterations - result.iterations
                              : std::min(config_.coarse_iterations,
                                         config_.max_iterations - result.iterations - (stages - 1 - stage));
      if (budget <= 0) continue;
      iterate_stage(stage, budget, last, now, quadratic, result);
    }
    result.map_cost_posterior = map_cost(now, quadratic.cost(now.readout));
    result.posterior = posterior(now, quadratic, constants);
    result.measurement = at_posterior(now, quadratic);
    result.correction_by_model = correction_by_model(now, quadratic);
    result.timing = timing_at_posterior(now, quadratic);
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
    iterate.tangents = iterate.measured.head<2 * kPoseSize>() + known_.head<2 * kPoseSize>();
    iterate.readout = iterate.measured.tail<kReadoutSize>() + known_.tail<kReadoutSize>();
    iterate.poses = {pose_plus(prior_.mean.T_world_imu, iterate.tangents.head<kPoseSize>()),
                     pose_plus(prior_.mean.T_world_imu, iterate.tangents.tail<kPoseSize>())};
    return iterate;
  }

  double map_cost(const Iterate& iterate, double measurement_cost) const {
    const double prior_cost = config_.prior_in_every_iteration ? 0.5 * iterate.y.dot(iterate.measured) : 0.0;
    return prior_cost + measurement_cost;
  }

  /// Derivatives of the tangents of both poses at the iterate with respect to the chart at the prior. Only
  /// the rotations differ from the identity.
  struct ChartJacobian {
    explicit ChartJacobian(const Iterate& iterate)
        : rotations{{{0, so3_right_jacobian(iterate.tangents.head<3>())},
                     {kPoseSize, so3_right_jacobian(iterate.tangents.segment<3>(kPoseSize))}}} {}

    [[nodiscard]] MeasuredVector times(MeasuredVector vector) const {
      for (const auto& [row, jacobian] : rotations)
        vector.segment<3>(row) = (jacobian * vector.segment<3>(row)).eval();
      return vector;
    }

    std::array<std::pair<int, Matrix3d>, 2> rotations;  ///< first row and derivative of each
  };

  /// Information and gradient of the measurement in the chart at the prior.
  struct ChartQuadratic {
    MeasuredMatrix information = MeasuredMatrix::Zero();
    MeasuredVector gradient = MeasuredVector::Zero();

    void add(const PoseQuadratic& pose, const ReadoutQuadratic& readout, int row) {
      constexpr int kReadout = 2 * kPoseSize;
      information.block<kPoseSize, kPoseSize>(row, row) += pose.information;
      information.block<kPoseSize, kReadoutSize>(row, kReadout) += readout.with_pose;
      information.block<kReadoutSize, kPoseSize>(kReadout, row) += readout.with_pose.transpose();
      information.block<kReadoutSize, kReadoutSize>(kReadout, kReadout) += readout.information;
      gradient.segment<kPoseSize>(row) += pose.gradient;
      gradient.tail<kReadoutSize>() += readout.gradient;
    }

    void carry(const ChartJacobian& chart) {
      for (const auto& [row, jacobian] : chart.rotations) {
        information.middleRows<3>(row) = (jacobian.transpose() * information.middleRows<3>(row)).eval();
        information.middleCols<3>(row) = (information.middleCols<3>(row) * jacobian).eval();
        gradient.segment<3>(row) = (jacobian.transpose() * gradient.segment<3>(row)).eval();
      }
    }
  };
  enum class Parts { all, by_reference };
  ChartQuadratic in_chart(const MeasurementQuadratic& quadratic, const Iterate& now,
                          Parts parts = Parts::all) const {
    ChartQuadratic result;
    result.add(quadratic.by_reference, quadratic.readout_by_reference, 0);
    if (parts == Parts::all) result.add(quadratic.by_model, quadratic.readout_by_model, kPoseSize);
    result.gradient += result.information.rightCols<kReadoutSize>() * (now.readout - quadratic.compensated);
    result.carry(ChartJacobian(now));
    if (config_.measurement == config::MeasurementForm::scalar_energy)
      take_as_one_number(quadratic.cost(now.readout), result);
    return result;
  }

  /// Eq. 17: a single residual, the energy, whose Jacobian is the total gradient.
  static void take_as_one_number(double energy, ChartQuadratic& quadratic) {
    constexpr double kEnergyVariance = 1;  // U_k for whitened residuals; the paper does not give it
    quadratic.information = quadratic.gradient * quadratic.gradient.transpose() / kEnergyVariance;
    quadratic.gradient *= energy / kEnergyVariance;
  }

  void iterate_stage(int stage, int budget, bool last, Iterate& now, MeasurementQuadratic& quadratic,
                     IekfResult& result) {
    quadratic = measurement_.linearise(now.poses, stage, false);
    if (last) result.map_cost_prior = map_cost(now, quadratic.cost(now.readout));
    result.converged = false;
    bool gated = false;
    for (int iteration = 0; iteration < budget && !result.converged; ++iteration) {
      const PoseHypothesis before = now.poses;
      const Step step = this->step(now, quadratic);
      if (step != Step::taken) {
        result.converged = step == Step::not_needed;
        break;
      }
      ++result.iterations;
      result.converged =
          is_small(pose_minus(now.poses.T_world_imu_by_reference, before.T_world_imu_by_reference)) &&
          is_small(pose_minus(now.poses.T_world_imu_by_model, before.T_world_imu_by_model));
      // The next stage linearises at this iterate.
      if (!last && (result.converged || iteration + 1 == budget)) break;
      quadratic = measurement_.linearise(now.poses, stage, last);
      gated = last;
    }
    if (last && !gated) quadratic = measurement_.linearise(now.poses, stage, true);
  }

  bool is_small(const Vector6d& tangent) const {
    return tangent.head<3>().norm() < config_.converged_rotation_rad &&
           tangent.tail<3>().norm() < config_.converged_translation_m;
  }

  /// Transports both parts to the posterior; the part by reference was linearised at another pose.
  static PoseQuadratic at_posterior(const Iterate& now, const MeasurementQuadratic& quadratic) {
    const Vector6d step = pose_minus(now.state.T_world_imu, now.poses.T_world_imu_by_reference);
    PoseQuadratic sum = quadratic.by_model;
    sum.add(quadratic.by_reference, 1.0);
    const ReadoutVector left = now.readout - quadratic.compensated;
    TangentVector steps = TangentVector::Zero();
    steps.head<kPoseSize>() = step;
    sum.gradient += (quadratic.readout_by_reference.with_pose + quadratic.readout_by_model.with_pose) * left;
    sum.cost += quadratic.readout_cost(now.readout, steps);
    const Vector6d change = quadratic.by_reference.information * step;
    sum.cost += step.dot(quadratic.by_reference.gradient) + 0.5 * step.dot(change);
    sum.gradient += change;
    return sum;
  }

  /// Difference to the optimum of the cost without the part by model.
  Vector6d correction_by_model(const Iterate& now, const MeasurementQuadratic& quadratic) const {
    const ChartQuadratic others = in_chart(quadratic, now, Parts::by_reference);
    const MeasuredMatrix system = MeasuredMatrix::Identity() + others.information * measured_covariance_;
    const MeasuredVector without =
        system.partialPivLu().solve(others.information * now.measured - others.gradient);
    return (now.measured - measured_covariance_ * without).segment<kPoseSize>(kPoseSize);
  }

  PoseTimingQuadratic timing_at_posterior(const Iterate& now, const MeasurementQuadratic& quadratic) const {
    const Vector6d step = pose_minus(now.state.T_world_imu, now.poses.T_world_imu_by_reference);
    const ReadoutQuadratic& by_reference = quadratic.readout_by_reference;
    const ReadoutQuadratic& by_model = quadratic.readout_by_model;
    const ReadoutVector gradient =
        by_reference.gradient + by_model.gradient + by_reference.with_pose.transpose() * step +
        (by_reference.information + by_model.information) * (now.readout - quadratic.compensated);
    PoseTimingQuadratic result;
    result.timing_s = prior_.mean.sensors.timing_s() + now.readout.head<kTimingSize>();
    result.with_pose = (by_reference.with_pose + by_model.with_pose).leftCols<kTimingSize>();
    result.information =
        (by_reference.information + by_model.information).topLeftCorner<kTimingSize, kTimingSize>();
    result.gradient = gradient.head<kTimingSize>();
    return result;
  }

  /// Gauss-Newton step, halved until the MAP cost decreases. not_needed: the cost does not decrease, but the
  /// step is below the rounding error.
  enum class Step { taken, not_needed, not_found };
  Step step(Iterate& now, const MeasurementQuadratic& quadratic) {
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
        ChartJacobian(now).times(measured_covariance_ * full).head<2 * kPoseSize>();
    const double cost_now = map_cost(now, quadratic.cost(now.readout));
    for (double fraction = 1.0; fraction > 0.05; fraction *= 0.5) {
      const Iterate trial = at(now.y + fraction * full);
      const double cost = map_cost(trial, measurement_.trial_cost(trial.poses, tangent_step, fraction) +
                                              quadratic.readout_cost(trial.readout, fraction * tangent_step));
      if (cost <= cost_now) {
        measurement_.accept();
        now = trial;
        return Step::taken;
      }
    }
    return is_small(tangent_step.head<kPoseSize>()) && is_small(tangent_step.tail<kPoseSize>())
               ? Step::not_needed
               : Step::not_found;
  }

  GaussianState posterior(const Iterate& now, const MeasurementQuadratic& quadratic,
                          SensorConstants constants) const {
    const MeasuredMatrix information = in_chart(quadratic, now).information;
    const MeasuredMatrix system = MeasuredMatrix::Identity() + information * measured_covariance_;
    const MeasuredMatrix reduction = system.partialPivLu().solve(information);
    StateMatrix in_chart_at_prior = prior_.covariance - gain_columns_ * reduction * gain_columns_.transpose();
    StateVector delta = now.delta;
    if (constants == SensorConstants::considered) {
      // Considered constants have a gain of zero. Their correlations with the other states still take part in
      // the update.
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
  const MeasuredVector known_ = known_at(prior_.mean);
  const MeasuredMatrix measured_covariance_;  ///< S = B P B^T
};

}  // namespace

double ReadoutQuadratic::cost(const ReadoutVector& errors, const Vector6d& step) const {
  return errors.dot(gradient + with_pose.transpose() * step + 0.5 * information * errors);
}

double MeasurementQuadratic::readout_cost(const ReadoutVector& errors, const TangentVector& steps) const {
  const ReadoutVector left = errors - compensated;
  return readout_by_reference.cost(left, steps.head<kPoseSize>()) +
         readout_by_model.cost(left, steps.tail<kPoseSize>());
}

double MeasurementQuadratic::cost(const ReadoutVector& errors) const {
  return by_reference.cost + by_model.cost + readout_cost(errors, TangentVector::Zero());
}

Vector6d correction_in_imu(const IekfResult& update) {
  Vector6d correction = update.correction_by_model;
  correction.tail<3>() = update.posterior.mean.T_world_imu.rotation.conjugate() * correction.tail<3>();
  return correction;
}

MeasuredVector start_at(const GaussianState& prior, const SE3& T_world_imu) {
  // Tolerance for a singular covariance: 0.1 mrad and 0.1 mm are sufficient for a start.
  constexpr double kTolerance = 1e-8;
  const auto combinations = measured_combinations(prior.mean);
  const MeasuredMatrix covariance = combinations * prior.covariance * combinations.transpose();
  const Vector6d tangent = pose_minus(T_world_imu, prior.mean.T_world_imu);
  MeasuredVector wanted = MeasuredVector::Zero();
  wanted.head<2 * kPoseSize>() -= known_at(prior.mean).head<2 * kPoseSize>();
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
