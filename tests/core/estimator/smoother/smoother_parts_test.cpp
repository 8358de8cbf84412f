#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "core/estimator/prediction/smoothed_sample.hpp"
#include "core/estimator/smoother/manifolds.hpp"
#include "core/estimator/smoother/relative_motion.hpp"
#include "core/estimator/smoother/selected_inverse.hpp"
#include "core/estimator/smoother/visual_scale.hpp"
#include "tests/support/large_matrices.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace simd;
using namespace filter;
using namespace prediction;
using namespace health;
using namespace smoother;

namespace {

using testing::numeric_jacobian;
using testing::relative_difference;

/// Plus and Minus undo each other, and the Jacobians are those of Plus and Minus.
void expect_manifold(const ceres::Manifold& manifold, const Eigen::VectorXd& x,
                     const Eigen::VectorXd& delta) {
  const int ambient = manifold.AmbientSize();
  const int tangent = manifold.TangentSize();
  const auto plus = [&](const Eigen::VectorXd& d) {
    Eigen::VectorXd y(ambient);
    manifold.Plus(x.data(), d.data(), y.data());
    return y;
  };
  Eigen::VectorXd back(tangent);
  manifold.Minus(plus(delta).data(), x.data(), back.data());
  EXPECT_LT((back - delta).norm(), 1e-12);

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowMajor by_delta(ambient, tangent);
  manifold.PlusJacobian(x.data(), by_delta.data());
  EXPECT_LT(relative_difference(by_delta, numeric_jacobian(plus, tangent)), 1e-8);
  RowMajor by_point(tangent, ambient);
  manifold.MinusJacobian(x.data(), by_point.data());
  EXPECT_LT(
      testing::distance(testing::product(by_point, by_delta), Eigen::MatrixXd::Identity(tangent, tangent)),
      1e-12);
}

TEST(Manifolds, RotationsMoveOnTheRight) {
  const Quaterniond q = so3_exp({0.3, -1.2, 0.7});
  const Vector3d delta(0.2, -0.1, 0.4);
  expect_manifold(RotationManifold{}, q.coeffs(), delta);
  Quaterniond moved;
  RotationManifold{}.Plus(q.coeffs().data(), delta.data(), moved.coeffs().data());
  EXPECT_LT(rotation_angle_rad(moved, q * so3_exp(delta)), 1e-12);
}

TEST(Manifolds, DirectionsStayUnit) {
  const Vector3d down = Vector3d(0.2, -0.9, 0.4).normalized();
  expect_manifold(DirectionManifold{}, down, Vector2d(0.3, -0.2));
}

/// Chains with an unknown connected to all others, as in batch problems.
TEST(SelectedInverse, AgreesWithTheDenseInverse) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const int frames = 12;
  const int size = 3 * frames + 2;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(8 * frames, size);
  for (int k = 0; k < frames; ++k) {
    for (int row = 8 * k; row < 8 * k + 8; ++row) {
      for (int i = 3 * k; i < std::min(3 * k + 6, 3 * frames); ++i) jacobian(row, i) = normal(random);
      jacobian(row, size - 2) = normal(random);
      jacobian(row, size - 1) = normal(random);
    }
  }
  const Eigen::MatrixXd dense = testing::product(jacobian.transpose(), jacobian);
  const SparseMatrixd sparse = dense.sparseView();
  const auto inverse = SelectedInverse::of(sparse);
  ASSERT_TRUE(inverse.has_value());
  const Eigen::MatrixXd expected = testing::inverse(dense);
  int compared = 0;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      if (dense(i, j) == 0.0) continue;
      EXPECT_NEAR(inverse->entry(i, j), expected(i, j), 1e-9 * expected.cwiseAbs().maxCoeff());
      ++compared;
    }
  }
  EXPECT_GT(compared, 8 * size);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(size, size).rightCols(2);
  EXPECT_LT(relative_difference(inverse->columns(unit), expected.rightCols(2)), 1e-9);
}

TEST(SelectedInverse, RefusesASingularMatrix) {
  SparseMatrixd singular(2, 2);
  singular.insert(0, 0) = 1;
  singular.insert(1, 1) = 0;
  EXPECT_FALSE(SelectedInverse::of(singular).has_value());
}

TEST(SmoothedSample, KeepsAParabolaAndTakesAwayNoise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<ImuSample> exact;
  std::vector<ImuSample> noisy;
  for (int i = -40; i <= 40; ++i) {
    const double t = 0.005 * i;
    ImuSample sample;
    sample.timestamp_ns = 1'000'000'000 + 5'000'000 * i;
    sample.angular_velocity_radps = Vector3d(1 + 2 * t, 3 * t * t, -1 + t - t * t);
    sample.specific_force_mps2 = Vector3d(9.81 - t * t, t, 2.0);
    exact.push_back(sample);
    for (int axis = 0; axis < 3; ++axis) sample.angular_velocity_radps[axis] += normal(random);
    noisy.push_back(sample);
  }
  const std::int64_t instant_ns = 1'003'000'000;
  const double t = 0.003;
  const ImuSample smoothed = smoothed_sample(exact, instant_ns, 0.1);
  EXPECT_LT((smoothed.angular_velocity_radps - Vector3d(1 + 2 * t, 3 * t * t, -1 + t - t * t)).norm(), 1e-12);
  EXPECT_LT((smoothed.specific_force_mps2 - Vector3d(9.81 - t * t, t, 2.0)).norm(), 1e-12);
  const ImuSample less_noisy = smoothed_sample(noisy, instant_ns, 0.1);
  EXPECT_LT((less_noisy.angular_velocity_radps - smoothed.angular_velocity_radps).norm(), 1.2);
  // At the end of the samples a parabola would amplify the noise: the nearest sample is used.
  EXPECT_EQ(smoothed_sample(noisy, 1'215'000'000, 0.1).angular_velocity_radps,
            noisy.back().angular_velocity_radps);
  // Too few samples: the nearest one.
  EXPECT_EQ(smoothed_sample(exact, 1'000'400'000, 0.001).timestamp_ns, 1'000'000'000);
}

Matrix6d some_information() {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = normal(random);
  return 1e4 * (root * root.transpose() + Matrix6d::Identity());
}
Matrix6d some_covariance() { return Matrix6d(testing::inverse(some_information())); }

TEST(VisualPose, IsTheOptimumOfTheEvidenceSeenFromTheCamera) {
  const SE3 T_imu_camera{so3_exp({0.1, -0.3, 0.2}), {0.09, -0.02, 0.05}};
  PoseEvidence evidence;
  evidence.T_world_imu = {so3_exp({0.4, 1.1, -0.3}), {1.0, -2.0, 0.5}};
  Vector6d step;
  step << 0.002, -0.001, 0.003, 0.004, 0.001, -0.002;
  evidence.quadratic.information = some_information();
  evidence.quadratic.gradient = -evidence.quadratic.information * step;

  const VisualPose seen = visual_pose(evidence, T_imu_camera);
  const SE3 T_world_imu = pose_plus(evidence.T_world_imu, step);
  EXPECT_LT(pose_minus(seen.T_world_camera, T_world_imu * T_imu_camera).norm(), 1e-12);

  const Eigen::MatrixXd camera_by_imu = numeric_jacobian(
      [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
        return pose_minus(pose_plus(T_world_imu, Vector6d(d)) * T_imu_camera, seen.T_world_camera);
      },
      6);
  const Eigen::MatrixXd expected =
      testing::carried(camera_by_imu, testing::inverse(evidence.quadratic.information));
  EXPECT_LT(testing::relative_distance(seen.covariance, expected), 1e-6);
}

TEST(VisualPose, KeepsUnobservableDirections) {
  PoseEvidence evidence;
  evidence.quadratic.information.diagonal() << 1e6, 1e6, 1e6, 1e6, 1e6, 0;
  evidence.quadratic.gradient << 0, 0, 0, 0, 0, 1e-3;
  const VisualPose seen = visual_pose(evidence, {});
  EXPECT_EQ(seen.T_world_camera.translation.z(), 0.0);
  EXPECT_NEAR(seen.covariance(5, 5), 1.0, 1e-12);
}

TEST(MotionBetween, CarriesTheUncertaintyOfBothPoses) {
  const VisualPose a{{so3_exp({0.2, 0.1, -0.4}), {0.3, 0.2, 1.0}}, some_covariance()};
  const VisualPose b{{so3_exp({0.5, -0.2, -0.1}), {0.9, -0.2, 1.3}}, 2.0 * some_covariance()};
  const RelativeCameraMotion motion = motion_between(a, b);
  const auto by = [&](bool first) {
    return numeric_jacobian(
        [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
          const SE3 T_a = first ? pose_plus(a.T_world_camera, Vector6d(d)) : a.T_world_camera;
          const SE3 T_b = first ? b.T_world_camera : pose_plus(b.T_world_camera, Vector6d(d));
          return pose_minus(T_a.inverse() * T_b, motion.T_reference_camera);
        },
        6);
  };
  const Eigen::MatrixXd expected =
      testing::carried(by(true), a.covariance) + testing::carried(by(false), b.covariance);
  EXPECT_LT(testing::relative_distance(motion.covariance, expected), 1e-6);
  const Eigen::MatrixXd root = whitening(motion);
  const Eigen::MatrixXd whitened = testing::product(testing::product(root, motion.covariance), root);
  EXPECT_LT(testing::distance(whitened, Matrix6d::Identity()), 1e-6);
}

/// A cost of pose and timing together: the best pose for each timing moves as by_timing says, and what is
/// left is the cost of the timing.
/// r_k = rho r_{k-1} + noise has the autocorrelation rho^k.
TEST(CorrelationFactor, OfAnAutoregressiveProcessIsTheSumOfItsPowers) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (const double rho : {0.0, 0.5, 0.8}) {
    std::vector<std::optional<Vector6d>> residuals;
    Vector6d r = Vector6d::Zero();
    for (int frame = 0; frame < 4000; ++frame) {
      for (int k = 0; k < 6; ++k) r[k] = rho * r[k] + std::sqrt(1 - rho * rho) * normal(random);
      residuals.push_back(frame % 10 == 9 ? std::nullopt : std::optional(r));  // some frames have no images
    }
    double expected = 1;
    for (double power = rho; power > 0.05; power *= rho) expected += 2 * power;
    EXPECT_NEAR(correlation_factor(residuals) / expected, 1.0, 0.12) << rho;
  }
}

TEST(VisualTiming, IsWhatTheBestPoseLeavesOfTheCost) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd root(9, 12);
  for (double& value : root.reshaped()) value = 100 * normal(random);
  const Eigen::MatrixXd information = testing::carried(root, Eigen::MatrixXd::Identity(12, 12));
  Eigen::VectorXd gradient(9);
  for (double& value : gradient) value = normal(random);
  PoseEvidence evidence;
  evidence.T_world_imu = {so3_exp({0.1, -0.2, 0.3}), {1, 2, 3}};
  evidence.quadratic.information = information.topLeftCorner<6, 6>();
  evidence.quadratic.gradient = gradient.head<6>();
  evidence.timing.timing_s = {0.01, -0.02, 0.03};
  evidence.timing.with_pose = information.topRightCorner<6, 3>();
  evidence.timing.information = information.bottomRightCorner<3, 3>();
  evidence.timing.gradient = gradient.tail<3>();

  const Eigen::MatrixXd covariance_of_pose = testing::inverse(information.topLeftCorner(6, 6));
  const auto best_step = [&](const Vector3d& change_s) -> Vector6d {
    const Eigen::MatrixXd by_timing = testing::product(information.topRightCorner(6, 3), change_s);
    return Vector6d(testing::product(covariance_of_pose, -(gradient.head(6) + by_timing)));
  };
  const auto cost = [&](const Vector3d& change_s) {
    Eigen::VectorXd x(9);
    x << best_step(change_s), change_s;
    return gradient.dot(x) + 0.5 * x.dot(testing::product(information, x).col(0));
  };
  const VisualTiming timing = visual_timing(evidence);
  EXPECT_EQ(timing.rank, 3);
  EXPECT_EQ(timing.timing_s, evidence.timing.timing_s);
  const Vector3d change_s(0.002, -0.001, 0.003);
  const double left = 0.5 * (timing.root * change_s + timing.residual).squaredNorm();
  EXPECT_NEAR(left - 0.5 * timing.residual.squaredNorm(), cost(change_s) - cost(Vector3d::Zero()), 1e-9);

  const VisualPose pose = visual_pose(evidence, SE3{});
  const Vector6d moved = pose.by_timing * change_s;
  EXPECT_LT((moved - (best_step(change_s) - best_step(Vector3d::Zero()))).norm(), 1e-6 * moved.norm());
  const VisualPose told = visual_pose(evidence, SE3{so3_exp({0, 0.1, 0}), {0.1, 0, 0}});
  EXPECT_NE(told.by_timing, pose.by_timing);
}

TEST(VisualTiming, HasNoInformationWithoutMotion) {
  PoseEvidence evidence;
  evidence.quadratic.information = 1e6 * Matrix6d::Identity();
  const VisualTiming timing = visual_timing(evidence);
  EXPECT_EQ(timing.rank, 0);
  EXPECT_EQ(timing.root, Matrix3d::Zero());
}

}  // namespace
}  // namespace fusebench
