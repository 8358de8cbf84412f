#include "core/estimator/filter/iekf.hpp"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/config/groups/filter_config.hpp"
#include "core/estimator/patches/posed_camera.hpp"
#include "core/estimator/prediction/motion_prior.hpp"
#include "tests/support/large_matrices.hpp"
#include "tests/support/scalar_residuals.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace config;
using namespace filter;
using namespace prediction;
using namespace patches;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::distance;
using testing::relative_distance;

/// A correlated, positive definite covariance in which every state depends on the pose.
StateMatrix some_covariance(double scale) {
  MatrixXd root(kStateSize, kStateSize);
  for (int i = 0; i < kStateSize; ++i) {
    for (int j = 0; j < kStateSize; ++j)
      root(i, j) = std::sin(1.0 + 3.0 * i + 7.0 * j) * 0.3 + (i == j ? 1.0 : 0.0);
  }
  return testing::carried(root, scale * MatrixXd::Identity(kStateSize, kStateSize));
}

FilterState some_state() {
  FilterState x;
  x.T_world_imu = {so3_exp({0.2, -0.1, 0.3}), {0.1, -0.7, 0.4}};
  x.velocity_world_mps = {0.5, -0.2, 0.1};
  x.gravity_direction_world = Vector3d(0.2, 0.9, -0.4).normalized();
  return x;
}

/// A measurement of the position, linear: z = p + noise.
class PositionMeasurement final : public PoseMeasurement {
 public:
  PositionMeasurement(Vector3d z, double sigma) : z_(std::move(z)), information_(1.0 / (sigma * sigma)) {}
  MeasurementQuadratic linearise(const PoseHypothesis& poses, int, bool) override {
    const Vector3d error = poses.T_world_imu_by_model.translation - z_;
    PoseQuadratic q;
    q.information.bottomRightCorner<3, 3>().diagonal().setConstant(information_);
    q.gradient.tail<3>() = information_ * error;
    q.cost = 0.5 * information_ * error.squaredNorm();
    return {{}, q};
  }
  double trial_cost(const PoseHypothesis& poses, const TangentVector&, double) override {
    return 0.5 * information_ * (poses.T_world_imu_by_model.translation - z_).squaredNorm();
  }
  void accept() override {}

 private:
  Vector3d z_;
  double information_;
};

/// Measurement in stages that counts its calls.
class StagedMeasurement final : public PoseMeasurement {
 public:
  explicit StagedMeasurement(PositionMeasurement& one) : one_(one) {}
  [[nodiscard]] int stages() const override { return 3; }
  MeasurementQuadratic linearise(const PoseHypothesis& poses, int stage, bool gate) override {
    linearised.push_back(stage);
    return one_.linearise(poses, stage, gate);
  }
  double trial_cost(const PoseHypothesis& poses, const TangentVector& step, double fraction) override {
    // Rounding must not refuse the last steps, which change nothing.
    return one_.trial_cost(poses, step, fraction) - 1e-9;
  }
  void accept() override { ++accepted; }

  std::vector<int> linearised;  ///< stages
  int accepted = 0;

 private:
  PositionMeasurement& one_;
};

TEST(Iekf, AScalarEnergyIsThePapersGainTimesItself) {
  const GaussianState prior{some_state(), some_covariance(1e-3)};
  const Vector3d z(0.101, -0.702, 0.4005);
  constexpr double kSigma = 0.02;
  PositionMeasurement measurement(z, kSigma);
  IekfConfig config;
  config.max_iterations = 1;
  config.prior_in_every_iteration = false;
  config.measurement = MeasurementForm::scalar_energy;
  const IekfResult result = iekf_update(prior, measurement, config);
  // Eqs. 19-22 with the energy E = |p - z|^2 / (2 sigma^2), H = (p - z)^T / sigma^2 and U = 1. The part by
  // the model is measured against the pose, of which the position is the last three.
  const Vector3d error = prior.mean.T_world_imu.translation - z;
  const double energy = 0.5 * error.squaredNorm() / (kSigma * kSigma);
  MatrixXd gradient = MatrixXd::Zero(1, kStateSize);
  gradient.block<1, 3>(0, kPosition) = error.transpose() / (kSigma * kSigma);
  const MatrixXd gain = testing::kalman_gain(prior.covariance, gradient, MatrixXd::Ones(1, 1));
  const FilterState expected = plus(prior.mean, StateVector(-gain * energy));
  EXPECT_LT((result.posterior.mean.T_world_imu.translation - expected.T_world_imu.translation).norm(), 1e-9);
  EXPECT_LT((result.posterior.mean.velocity_world_mps - expected.velocity_world_mps).norm(), 1e-9);
  // The gradient is zero at the minimum of the energy: the posterior is the prior.
  PositionMeasurement at_rest(prior.mean.T_world_imu.translation, kSigma);
  const IekfResult nothing = iekf_update(prior, at_rest, config);
  EXPECT_LT(distance(nothing.posterior.covariance, prior.covariance), 1e-12);
}

TEST(Iekf, LinearisesOnceAStepAndOnceMoreForThePosterior) {
  const GaussianState prior{some_state(), some_covariance(1e-3)};
  PositionMeasurement position({0.13, -0.68, 0.47}, 0.02);
  StagedMeasurement measurement(position);
  const IekfResult result = iekf_update(prior, measurement, IekfConfig{});
  EXPECT_GT(result.iterations, 3);
  EXPECT_EQ(measurement.accepted, result.iterations);
  EXPECT_EQ(static_cast<int>(measurement.linearised.size()), result.iterations + 1);
  EXPECT_TRUE(std::is_sorted(measurement.linearised.begin(), measurement.linearised.end()));
  EXPECT_EQ(measurement.linearised.front(), 0);
  EXPECT_EQ(measurement.linearised.back(), 2);
}

TEST(Iekf, WithoutThePriorInEveryIterationConvergesToTheMeasurement) {
  const GaussianState prior{some_state(), some_covariance(1e-3)};
  const Vector3d z(0.13, -0.68, 0.47);
  PositionMeasurement measurement(z, 0.2);  // much less certain than the prediction
  IekfConfig config;
  config.prior_in_every_iteration = false;
  config.max_iterations = 200;
  config.converged_rotation_rad = config.converged_translation_m = 0;
  const IekfResult result = iekf_update(prior, measurement, config);
  EXPECT_LT((result.posterior.mean.T_world_imu.translation - z).norm(), 1e-3);
  config.prior_in_every_iteration = true;
  const IekfResult weighed = iekf_update(prior, measurement, config);
  EXPECT_GT((weighed.posterior.mean.T_world_imu.translation - z).norm(), 1e-2);
}

TEST(Iekf, EqualsOneKalmanUpdateOnALinearProblemFromAnyStart) {
  const GaussianState prior{some_state(), some_covariance(1e-3)};
  const Vector3d z(0.13, -0.68, 0.47);
  const double sigma = 0.02;
  MatrixXd H = MatrixXd::Zero(3, kStateSize);
  H.block<3, 3>(0, kPosition).setIdentity();
  const MatrixXd K = testing::kalman_gain(prior.covariance, H, sigma * sigma * Matrix3d::Identity());
  const StateVector delta(testing::product(K, z - prior.mean.T_world_imu.translation));
  const MatrixXd expected =
      testing::carried(chart_transport(prior.mean, delta), testing::after_update(prior.covariance, K, H));

  MeasuredVector far_start;
  far_start << 300, -500, 200, 800, -400, 900, -200, 400, 700, -600, 500, 300, 200, -100, 400, 100, -300, 600,
      -700, 200, 500, 300, -400, 200, -600, 100, 700, -300;
  for (const MeasuredVector& start : {MeasuredVector(MeasuredVector::Zero()), far_start}) {
    PositionMeasurement measurement(z, sigma);
    const IekfResult result = iekf_update(prior, measurement, IekfConfig{}, start);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(distance(minus(result.posterior.mean, prior.mean), delta), 1e-9);
    EXPECT_LT(relative_distance(result.posterior.covariance, expected), 1e-9);
  }
}

/// A linear measurement of the pose by the model, to which errors of the read-out add.
using ByReadout = Eigen::Matrix<double, 3, kReadoutSize>;
class ReadOutMeasurement final : public PoseMeasurement {
 public:
  /// compensated: errors that the images are free of already.
  ReadOutMeasurement(Vector3d z, double sigma, const ByReadout& by_readout,
                     const ReadoutVector& compensated = ReadoutVector::Zero())
      : z_(z - by_readout * compensated),
        information_(1.0 / (sigma * sigma)),
        by_readout_(by_readout),
        compensated_(compensated) {}
  MeasurementQuadratic linearise(const PoseHypothesis& poses, int, bool) override {
    const Vector3d error = poses.T_world_imu_by_model.translation - z_;
    MeasurementQuadratic q;
    q.by_model.information.bottomRightCorner<3, 3>().diagonal().setConstant(information_);
    q.by_model.gradient.tail<3>() = information_ * error;
    q.by_model.cost = 0.5 * information_ * error.squaredNorm();
    q.readout_by_model.with_pose.bottomRows<3>() = information_ * by_readout_;
    q.readout_by_model.information = information_ * by_readout_.transpose() * by_readout_;
    q.readout_by_model.gradient = information_ * by_readout_.transpose() * error;
    q.compensated = compensated_;
    return q;
  }
  double trial_cost(const PoseHypothesis& poses, const TangentVector&, double) override {
    return 0.5 * information_ * (poses.T_world_imu_by_model.translation - z_).squaredNorm();
  }
  void accept() override {}

 private:
  Vector3d z_;
  double information_;
  ByReadout by_readout_;
  ReadoutVector compensated_;
};

/// z = p + by_readout * errors + noise, by the textbook. The errors of the rate are those against what is
/// wrong with reference and model.
struct ReadOutUpdate {
  MatrixXd H = MatrixXd::Zero(3, kStateSize);
  MatrixXd K;
  VectorXd delta;

  ReadOutUpdate(const GaussianState& prior, const Vector3d& z, double sigma, const ByReadout& by_readout) {
    H.block<3, 3>(0, kPosition).setIdentity();
    H.block<3, 3>(0, kColorReadout) = by_readout.leftCols<3>();
    const Matrix6d carried = pose_transport(prior.mean.T_world_imu, prior.mean.T_world_imu_reference);
    Vector3d expected = prior.mean.T_world_imu.translation;
    const auto add_rate = [&](int column, StateOffset clone, const Vector6d& offset) {
      const Eigen::Matrix<double, 3, kPoseSize> by_rate = by_readout.middleCols<kPoseSize>(column);
      H.block<3, 3>(0, kAngularVelocity) += by_rate.leftCols<3>();
      H.block<3, 3>(0, kVelocity) += by_rate.rightCols<3>();
      H.block<3, kPoseSize>(0, clone) = -by_rate * carried;
      expected -= by_rate * carried * offset;
    };
    // The affine term between timing and rates has no error.
    add_rate(kTimingSize + 1, kReferenceRate, prior.mean.reference_rate_offset);
    add_rate(kTimingSize + 1 + kPoseSize, kModelRate, prior.mean.model_rate_offset);
    K = testing::kalman_gain(prior.covariance, H, sigma * sigma * Matrix3d::Identity());
    delta = testing::product(K, z - expected);
  }
};

FilterState state_with_distorted_images() {
  FilterState x = some_state();
  x.T_world_imu_reference = {so3_exp({0.25, -0.1, 0.2}), {0.2, -0.6, 0.3}};
  x.reference_rate_offset << 0.3, -0.2, 0.5, 0.1, -0.3, 0.2;
  x.model_rate_offset << -0.4, 0.1, 0.2, -0.2, 0.1, 0.3;
  return x;
}

const ByReadout kByReadout = [] {
  ByReadout by_readout = ByReadout::Zero();
  by_readout.leftCols<3>() << 0.8, -0.3, 0.1, 0.2, 0.5, -0.4, -0.1, 0.6, 0.9;
  by_readout.col(3) << 0.02, -0.05, 0.03;
  by_readout.middleCols<3>(4) << 0.02, -0.01, 0.03, -0.03, 0.01, 0.02, 0.01, 0.02, -0.02;
  by_readout.middleCols<3>(7).diagonal().setConstant(0.01);
  by_readout.middleCols<3>(10) << -0.01, 0.02, 0.01, 0.02, 0.03, -0.01, -0.02, 0.01, 0.01;
  by_readout.rightCols<3>().diagonal().setConstant(0.015);
  return by_readout;
}();

TEST(Iekf, EqualsOneKalmanUpdateOfPoseAndReadout) {
  const GaussianState prior{state_with_distorted_images(), some_covariance(1e-3)};
  const Vector3d z(0.13, -0.68, 0.47);
  const ReadOutUpdate expected(prior, z, 0.02, kByReadout);
  const MatrixXd covariance =
      testing::carried(chart_transport(prior.mean, StateVector(expected.delta)),
                       testing::after_update(prior.covariance, expected.K, expected.H));
  ReadoutVector compensated;
  compensated << 0.01, -0.02, 0.015, -1, 0.5, -0.4, 0.3, 0.1, 0.2, -0.1, 0.5, -0.4, 0.3, 0.1, 0.2, -0.1;
  for (const ReadoutVector& prepared_for : {ReadoutVector(ReadoutVector::Zero()), compensated}) {
    ReadOutMeasurement measurement(z, 0.02, kByReadout, prepared_for);
    const IekfResult result = iekf_update(prior, measurement, IekfConfig{});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(distance(minus(result.posterior.mean, prior.mean), expected.delta), 1e-9);
    EXPECT_LT(relative_distance(result.posterior.covariance, covariance), 1e-9);
  }
}

TEST(Iekf, ConsideredConstantsStayAndAreNotForgotten) {
  const GaussianState prior{state_with_distorted_images(), some_covariance(1e-3)};
  const Vector3d z(0.13, -0.68, 0.47);
  ReadOutUpdate schmidt(prior, z, 0.02, kByReadout);
  // Schmidt's filter: their rows of the gain are zero, and the covariance is Joseph's for that gain.
  schmidt.K.middleRows(kImuTimeOffset, kSensorSize).setZero();
  schmidt.delta.segment(kImuTimeOffset, kSensorSize).setZero();
  ReadOutMeasurement measurement(z, 0.02, kByReadout);
  const IekfResult result =
      iekf_update(prior, measurement, IekfConfig{}, MeasuredVector::Zero(), SensorConstants::considered);
  EXPECT_LT(distance(minus(result.posterior.mean, prior.mean), schmidt.delta), 1e-9);
  const MatrixXd in_chart =
      testing::joseph(prior.covariance, schmidt.K, schmidt.H, 0.02 * 0.02 * Matrix3d::Identity());
  const MatrixXd covariance =
      testing::carried(chart_transport(prior.mean, StateVector(schmidt.delta)), in_chart);
  EXPECT_LT(relative_distance(result.posterior.covariance, covariance), 1e-9);
}

TEST(Iekf, WithoutInformationKeepsThePriorToTheLastBit) {
  const GaussianState prior{some_state(), some_covariance(1e-3)};
  PositionMeasurement nothing(Vector3d::Zero(), 1e30);
  const IekfResult result = iekf_update(prior, nothing, IekfConfig{});
  EXPECT_LT(distance(minus(result.posterior.mean, prior.mean), VectorXd::Zero(kStateSize)), 1e-15);
  EXPECT_LT(distance(result.posterior.covariance, prior.covariance), 1e-15);
}

TEST(Iekf, AcceptsASingularPrior) {
  // The first pose is exact: its covariance is zero, and no measurement may move it.
  GaussianState prior{some_state(), StateMatrix::Zero()};
  prior.covariance.block<3, 3>(kVelocity, kVelocity).setIdentity();
  PositionMeasurement measurement(Vector3d(5, 5, 5), 0.01);
  const IekfResult result = iekf_update(prior, measurement, IekfConfig{});
  EXPECT_EQ((result.posterior.mean.T_world_imu.translation - prior.mean.T_world_imu.translation).norm(), 0.0);
  EXPECT_TRUE(MatrixXd(result.posterior.covariance).allFinite());
}

/// Points on known planes, seen from an unknown pose: point-to-plane residuals with Huber's loss and some
/// outliers.
struct PlaneProblem {
  std::vector<Vector3d> points_imu, plane_points, normals;
  double sigma_m = 0.01;
  double huber_sigmas = 1.345;
};

PlaneProblem plane_problem(const SE3& T_world_imu_true) {
  PlaneProblem problem;
  for (int i = 0; i < 60; ++i) {
    const Vector3d normal =
        Vector3d(std::sin(2.1 * i), std::cos(1.3 * i), std::sin(0.7 * i + 1)).normalized();
    const Vector3d point_world(1.5 * std::sin(0.9 * i), std::cos(2.3 * i), 2 + 0.5 * std::sin(1.7 * i));
    const double noise_m = 0.01 * std::sin(12.9898 * i) + (i % 9 == 0 ? 0.2 : 0.0);
    problem.points_imu.push_back(T_world_imu_true.inverse() * (point_world + noise_m * normal));
    problem.plane_points.push_back(point_world);
    problem.normals.push_back(normal);
  }
  return problem;
}

class PlaneMeasurement final : public PoseMeasurement {
 public:
  explicit PlaneMeasurement(const PlaneProblem& problem) : problem_(problem) {}
  MeasurementQuadratic linearise(const PoseHypothesis& poses, int, bool) override {
    PoseQuadratic q;
    const PosedCamera posed(testing::small_camera(), poses.T_world_imu_by_model, SE3{});
    for (std::size_t i = 0; i < problem_.normals.size(); ++i) {
      const testing::PlaneResidual r = testing::point_to_plane_residual(
          posed, problem_.points_imu[i], problem_.plane_points[i], problem_.normals[i]);
      const testing::RobustValue robust = testing::huber(r.value_m / problem_.sigma_m, problem_.huber_sigmas);
      const double weight = robust.weight / (problem_.sigma_m * problem_.sigma_m);
      q.information += weight * r.jacobian.transpose() * r.jacobian;
      q.gradient += weight * r.value_m * r.jacobian.transpose();
      q.cost += robust.cost;
    }
    return {{}, q};
  }
  double trial_cost(const PoseHypothesis& poses, const TangentVector&, double) override {
    return linearise(poses, 0, false).cost();
  }
  void accept() override {}

 private:
  const PlaneProblem& problem_;
};

/// The same cost for Ceres, implemented separately: |d|^2_P for d in the full chart at the prior is its
/// NormalPrior, plus the planes.
struct PlaneCost {
  SE3 T_world_imu_prior;
  Vector3d point_imu, plane_point, normal;
  double sigma_m;
  template <class T>
  bool operator()(const T* delta, T* residual) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> phi(delta + kRotation);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> shift(delta + kPosition);
    const T angle = sqrt(phi.squaredNorm() + T(1e-30));
    const Eigen::Matrix<T, 3, 1> p = point_imu.cast<T>();
    const Eigen::Matrix<T, 3, 1> axis = phi / angle;
    const Eigen::Matrix<T, 3, 1> turned =
        p * cos(angle) + axis.cross(p) * sin(angle) + axis * (axis.dot(p) * (T(1) - cos(angle)));
    const Eigen::Matrix<T, 3, 1> point_world =
        T_world_imu_prior.rotation.toRotationMatrix().cast<T>() * turned +
        T_world_imu_prior.translation.cast<T>() + shift;
    residual[0] = normal.cast<T>().dot(point_world - plane_point.cast<T>()) / T(sigma_m);
    return true;
  }
};

/// A plane depends on the pose only, the first part of the error state: the other derivatives are zero.
class PlaneOfTheState final : public ceres::SizedCostFunction<1, kStateSize> {
 public:
  explicit PlaneOfTheState(const PlaneCost& cost) : by_pose_(new PlaneCost(cost)) {}
  bool Evaluate(double const* const* deltas, double* residual, double** jacobians) const override {
    if (jacobians == nullptr || jacobians[0] == nullptr) return by_pose_.Evaluate(deltas, residual, nullptr);
    std::fill_n(jacobians[0], kStateSize, 0.0);
    return by_pose_.Evaluate(deltas, residual, jacobians);
  }

 private:
  ceres::AutoDiffCostFunction<PlaneCost, 1, kPoseSize> by_pose_;
};

TEST(Iekf, ConvergedUpdateEqualsACeresSolutionOfTheSameMapCost) {
  GaussianState prior{some_state(), some_covariance(4e-4)};
  const SE3 truth{prior.mean.T_world_imu.rotation * so3_exp({0.03, -0.05, 0.02}),
                  prior.mean.T_world_imu.translation + Vector3d(0.04, 0.02, -0.05)};
  const PlaneProblem planes = plane_problem(truth);

  StateVector delta = StateVector::Zero();
  ceres::Problem problem;
  const MatrixXd root = testing::root_information(prior.covariance);
  problem.AddResidualBlock(new ceres::NormalPrior(root, VectorXd::Zero(kStateSize)), nullptr, delta.data());
  for (std::size_t i = 0; i < planes.normals.size(); ++i) {
    const PlaneCost cost{prior.mean.T_world_imu, planes.points_imu[i], planes.plane_points[i],
                         planes.normals[i], planes.sigma_m};
    problem.AddResidualBlock(new PlaneOfTheState(cost), new ceres::HuberLoss(planes.huber_sigmas),
                             delta.data());
  }
  ceres::Solver::Options options;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  IekfConfig config;
  config.max_iterations = 200;
  config.converged_rotation_rad = config.converged_translation_m = 1e-12;
  PlaneMeasurement measurement(planes);
  const IekfResult result = iekf_update(prior, measurement, config);
  EXPECT_LT(distance(minus(result.posterior.mean, prior.mean), delta), 1e-7);
  EXPECT_NEAR(result.map_cost_posterior, summary.final_cost, 1e-9 * summary.final_cost);
  EXPECT_LT(result.map_cost_posterior, result.map_cost_prior);
}

/// The position by the reference, linear. Linearised at the pose of its first call.
class PositionByReference final : public PoseMeasurement {
 public:
  explicit PositionByReference(Vector3d z) : z_(std::move(z)) {}
  MeasurementQuadratic linearise(const PoseHypothesis& poses, int, bool) override {
    if (!first) first = poses.T_world_imu_by_reference;
    const Vector3d error = poses.T_world_imu_by_reference.translation - z_;
    PoseQuadratic q;
    q.information.bottomRightCorner<3, 3>().diagonal().setConstant(kInformation);
    q.gradient.tail<3>() = kInformation * error;
    q.cost = cost_at(poses.T_world_imu_by_reference);
    return {q, {}};
  }
  double trial_cost(const PoseHypothesis& poses, const TangentVector&, double) override {
    return cost_at(poses.T_world_imu_by_reference);
  }
  void accept() override {}
  [[nodiscard]] double cost_at(const SE3& T_world_imu) const {
    return 0.5 * kInformation * (T_world_imu.translation - z_).squaredNorm();
  }

  static constexpr double kInformation = 400;
  std::optional<SE3> first;

 private:
  Vector3d z_;
};

GaussianState prior_with_reference_offset() {
  GaussianState prior{some_state(), some_covariance(1e-4)};
  prior.mean.T_world_imu_reference = {so3_exp({0.7, -0.4, 0.9}), {1.3, 0.2, -0.8}};
  prior.mean.reference_offset << 2e-5, -3e-5, 1e-5, 4e-5, 1e-5, -2e-5;
  return prior;
}

/// The images measure against the reference where it was before an earlier update moved it by its offset.
TEST(Iekf, AnOffsetOfTheReferenceMovesThePoseThatIsMeasuredRigidly) {
  const GaussianState prior = prior_with_reference_offset();
  PositionByReference measurement(prior.mean.T_world_imu.translation);
  static_cast<void>(iekf_update(prior, measurement, IekfConfig{}));
  ASSERT_TRUE(measurement.first);
  const SE3 displaced = pose_plus(prior.mean.T_world_imu_reference, prior.mean.reference_offset);
  const SE3 carried = displaced * prior.mean.T_world_imu_reference.inverse() * prior.mean.T_world_imu;
  const Vector6d expected = -pose_minus(carried, prior.mean.T_world_imu);
  EXPECT_LT((pose_minus(*measurement.first, prior.mean.T_world_imu) - expected).norm(),
            1e-3 * expected.norm());
}

TEST(Iekf, TheMeasurementThatIsHandedOnIsTheCostAroundThePosterior) {
  GaussianState prior = prior_with_reference_offset();
  prior.mean.reference_offset *= 1000;
  PositionByReference measurement(prior.mean.T_world_imu.translation + Vector3d(0.02, -0.01, 0.03));
  const IekfResult result = iekf_update(prior, measurement, IekfConfig{});
  const SE3& at = result.posterior.mean.T_world_imu;
  EXPECT_GT((at.translation - measurement.first->translation).norm(), 0.01) << "another pose is measured";
  EXPECT_NEAR(result.measurement.cost / measurement.cost_at(at), 1.0, 1e-6);
  Vector6d step = Vector6d::Zero();
  step.tail<3>() = Vector3d(0.03, 0.01, -0.02);
  const double moved = result.measurement.cost + step.dot(result.measurement.gradient) +
                       0.5 * step.dot(result.measurement.information * step);
  EXPECT_NEAR(moved / measurement.cost_at(pose_plus(at, step)), 1.0, 1e-6);
}

TEST(Iekf, OneIterationIsThePlainFilterAndFallsShortOfTheOptimum) {
  GaussianState prior{some_state(), some_covariance(4e-4)};
  const SE3 truth{prior.mean.T_world_imu.rotation * so3_exp({0.3, -0.2, 0.25}),
                  prior.mean.T_world_imu.translation + Vector3d(0.04, 0.02, -0.05)};
  const PlaneProblem planes = plane_problem(truth);
  IekfConfig single;
  single.max_iterations = 1;
  PlaneMeasurement measurement(planes);
  const IekfResult one = iekf_update(prior, measurement, single);
  const IekfResult many = iekf_update(prior, measurement, IekfConfig{});
  EXPECT_EQ(one.iterations, 1);
  EXPECT_GT(one.map_cost_posterior, many.map_cost_posterior);
}

}  // namespace
}  // namespace fusebench
