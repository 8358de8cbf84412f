#include "core/estimator/smoother/batch_problem.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/estimator/smoother/manifolds.hpp"
#include "core/estimator/smoother/residuals.hpp"

namespace fusebench::smoother {

namespace {

/// Square root of the inverse covariance of an increment. A floor far below the noise of any sensor keeps it
/// regular for intervals with one or two samples.
prediction::Matrix9d whitening_of(const prediction::Matrix9d& covariance) {
  constexpr double kRotationFloorRad = 1e-5;
  constexpr double kVelocityFloorMps = 1e-4;
  constexpr double kPositionFloorM = 1e-5;
  prediction::Matrix9d regular = covariance;
  regular.diagonal().segment<3>(0).array() += kRotationFloorRad * kRotationFloorRad;
  regular.diagonal().segment<3>(3).array() += kVelocityFloorMps * kVelocityFloorMps;
  regular.diagonal().segment<3>(6).array() += kPositionFloorM * kPositionFloorM;
  const Eigen::LLT<prediction::Matrix9d> root(regular);
  return root.matrixL().solve(prediction::Matrix9d::Identity());
}

double step_sigma(double density, double duration_s) {
  return std::max(density, 1e-9) * std::sqrt(duration_s);
}

template <int Size>
ceres::CostFunction* vector_prior(const Eigen::Matrix<double, Size, 1>& expected,
                                  const Eigen::Matrix<double, Size, 1>& sigma) {
  return new ceres::AutoDiffCostFunction<VectorPrior<Size>, Size, Size>(
      new VectorPrior<Size>{expected, sigma});
}

}  // namespace

BatchProblem::BatchProblem(const BatchInput& input, const BatchOptions& options,
                           const std::vector<prediction::PreintegratedImu>& increments,
                           const Weighting& visual, const Weighting& timing, BatchUnknowns& unknowns)
    : input_(input), options_(options), increments_(increments), unknowns_(unknowns) {
  add_unknowns();
  add_visual(visual);
  add_inertial();
  add_timing(timing);
  add_priors();
}

void BatchProblem::add_unknowns() {
  BatchUnknowns& x = unknowns_;
  for (std::size_t k = 0; k < x.rotation_world_imu.size(); ++k) {
    problem_.AddParameterBlock(x.rotation_world_imu[k].coeffs().data(), 4, new RotationManifold);
    problem_.AddParameterBlock(x.position_world_m[k].data(), 3);
    problem_.AddParameterBlock(x.velocity_world_mps[k].data(), 3);
    problem_.AddParameterBlock(x.bias[k].data(), 6);
  }
  problem_.AddParameterBlock(x.gravity_direction_world.data(), 3, new DirectionManifold);
  problem_.AddParameterBlock(x.T_imu_camera.rotation.coeffs().data(), 4, new RotationManifold);
  problem_.AddParameterBlock(x.T_imu_camera.translation.data(), 3);
  problem_.AddParameterBlock(&x.time_offset_s, 1);
  problem_.AddParameterBlock(x.scales.gyroscope.data(), 3);
  problem_.AddParameterBlock(x.scales.accelerometer.data(), 3);
  for (double& timing_s : x.timing_s) problem_.AddParameterBlock(&timing_s, 1);

  problem_.SetParameterBlockConstant(x.rotation_world_imu.front().coeffs().data());
  problem_.SetParameterBlockConstant(x.position_world_m.front().data());
  if (!(options_.rotation_prior_rad > 0))
    problem_.SetParameterBlockConstant(x.T_imu_camera.rotation.coeffs().data());
  if (!(options_.translation_prior_m > 0))
    problem_.SetParameterBlockConstant(x.T_imu_camera.translation.data());
  if (!(options_.time_offset_prior_s > 0)) problem_.SetParameterBlockConstant(&x.time_offset_s);
  if (!(options_.gyroscope_scale_prior > 0)) problem_.SetParameterBlockConstant(x.scales.gyroscope.data());
  if (!(options_.accelerometer_scale_prior > 0))
    problem_.SetParameterBlockConstant(x.scales.accelerometer.data());
  for (int i = 0; i < 3; ++i)
    if (!(options_.timing_prior_s[i] > 0)) problem_.SetParameterBlockConstant(&x.timing_s[i]);
}

prediction::InertialErrors BatchProblem::errors_at(const BatchUnknowns& unknowns, std::size_t frame) {
  return {unknowns.bias[frame].head<3>(), unknowns.bias[frame].tail<3>(), Vector3d::Zero(),
          unknowns.scales.gyroscope, unknowns.scales.accelerometer};
}

void BatchProblem::add_inertial() {
  BatchUnknowns& x = unknowns_;
  for (std::size_t k = 0; k < increments_.size(); ++k) {
    const prediction::PreintegratedImu& imu = increments_[k];
    auto* residual =
        new InertialResidual{imu, errors_at(x, k), x.time_offset_s, whitening_of(imu.covariance)};
    inertial_.push_back(problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<InertialResidual, 9, 4, 3, 3, 6, 4, 3, 3, 3, 1, 3, 3>(residual),
        nullptr, x.rotation_world_imu[k].coeffs().data(), x.position_world_m[k].data(),
        x.velocity_world_mps[k].data(), x.bias[k].data(), x.rotation_world_imu[k + 1].coeffs().data(),
        x.position_world_m[k + 1].data(), x.velocity_world_mps[k + 1].data(),
        x.gravity_direction_world.data(), &x.time_offset_s, x.scales.gyroscope.data(),
        x.scales.accelerometer.data()));
    auto* walk =
        new BiasWalkResidual{step_sigma(input_.imu_noise.gyroscope_bias_radps2_sqrthz, imu.duration_s),
                             step_sigma(input_.imu_noise.accelerometer_bias_mps3_sqrthz, imu.duration_s)};
    rest_.push_back(
        problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<BiasWalkResidual, 6, 6, 6>(walk), nullptr,
                                  x.bias[k].data(), x.bias[k + 1].data()));
  }
}

void BatchProblem::add_visual(const Weighting& weighting) {
  BatchUnknowns& x = unknowns_;
  for (const RelativeCameraMotion& motion : input_.visual) {
    auto* residual = new VisualResidual{motion, whitening(motion) / std::sqrt(weighting.scale)};
    visual_.push_back(problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<VisualResidual, 6, 4, 3, 4, 3, 4, 3, 1, 1, 1>(residual),
        new ceres::HuberLoss(weighting.outlier_sigmas),
        x.rotation_world_imu[motion.reference].coeffs().data(), x.position_world_m[motion.reference].data(),
        x.rotation_world_imu[motion.frame].coeffs().data(), x.position_world_m[motion.frame].data(),
        x.T_imu_camera.rotation.coeffs().data(), x.T_imu_camera.translation.data(), &x.timing_s[0],
        &x.timing_s[1], &x.timing_s[2]));
  }
}

void BatchProblem::add_timing(const Weighting& weighting) {
  BatchUnknowns& x = unknowns_;
  for (const VisualTiming& timing : input_.timing) {
    timing_.push_back(problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<TimingResidual, 3, 1, 1, 1>(
            new TimingResidual{timing, 1 / std::sqrt(weighting.scale)}),
        new ceres::HuberLoss(weighting.outlier_sigmas), &x.timing_s[0], &x.timing_s[1], &x.timing_s[2]));
  }
}

void BatchProblem::add_priors() {
  BatchUnknowns& x = unknowns_;
  const SE3 T_expected = options_.T_imu_camera_expected.value_or(input_.T_imu_camera);
  const double offset_expected_s = options_.time_offset_expected_s.value_or(input_.time_offset_s);
  Vector6d bias_sigma;
  bias_sigma << Vector3d::Constant(options_.gyroscope_bias_sigma_radps),
      Vector3d::Constant(options_.accelerometer_bias_sigma_mps2);
  rest_.push_back(problem_.AddResidualBlock(vector_prior<6>(Vector6d::Zero(), bias_sigma), nullptr,
                                            x.bias.front().data()));
  // Weak prior on the camera speed; it only matters without visual measurements.
  rest_.push_back(problem_.AddResidualBlock(vector_prior<3>(Vector3d::Zero(), Vector3d::Constant(10.0)),
                                            nullptr, x.velocity_world_mps.front().data()));
  if (options_.rotation_prior_rad > 0) {
    auto* prior = new RotationPrior{T_expected.rotation, options_.rotation_prior_rad};
    rest_.push_back(problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<RotationPrior, 3, 4>(prior),
                                              nullptr, x.T_imu_camera.rotation.coeffs().data()));
  }
  if (options_.translation_prior_m > 0) {
    rest_.push_back(problem_.AddResidualBlock(
        vector_prior<3>(T_expected.translation, Vector3d::Constant(options_.translation_prior_m)), nullptr,
        x.T_imu_camera.translation.data()));
  }
  if (options_.time_offset_prior_s > 0) {
    using Scalar = Eigen::Matrix<double, 1, 1>;
    rest_.push_back(problem_.AddResidualBlock(
        vector_prior<1>(Scalar(offset_expected_s), Scalar(options_.time_offset_prior_s)), nullptr,
        &x.time_offset_s));
  }
  add_sensor_priors();
}

void BatchProblem::add_sensor_priors() {
  BatchUnknowns& x = unknowns_;
  const auto add_scale = [&](Vector3d& scale, double sigma) {
    if (!(sigma > 0)) return;
    rest_.push_back(problem_.AddResidualBlock(vector_prior<3>(Vector3d::Zero(), Vector3d::Constant(sigma)),
                                              nullptr, scale.data()));
  };
  add_scale(x.scales.gyroscope, options_.gyroscope_scale_prior);
  add_scale(x.scales.accelerometer, options_.accelerometer_scale_prior);
  using Scalar = Eigen::Matrix<double, 1, 1>;
  for (int i = 0; i < 3; ++i) {
    if (!(options_.timing_prior_s[i] > 0)) continue;
    rest_.push_back(problem_.AddResidualBlock(
        vector_prior<1>(Scalar(options_.timing_expected_s[i]), Scalar(options_.timing_prior_s[i])), nullptr,
        &x.timing_s[i]));
  }
}

bool BatchProblem::solve() {
  ceres::Solver::Options options;
  options.num_threads = 1;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // CHOLMOD instead of Eigen's factorisation: Ceres was built with another alignment of Eigen types (see
  // selected_inverse.hpp). Debian's reference BLAS has one kernel for all processors; with another BLAS the
  // last bits may differ.
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-9;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  return summary.IsSolutionUsable();
}

BatchLinearisation BatchProblem::linearise() {
  BatchUnknowns& x = unknowns_;
  BatchLinearisation result;
  BatchColumns& columns = result.columns;
  ceres::Problem::EvaluateOptions options;
  const auto add = [&](double* block) {
    if (problem_.IsParameterBlockConstant(block)) return -1;
    options.parameter_blocks.push_back(block);
    return std::exchange(columns.count, columns.count + problem_.ParameterBlockTangentSize(block));
  };
  for (std::size_t k = 0; k < x.rotation_world_imu.size(); ++k) {
    columns.rotation.push_back(add(x.rotation_world_imu[k].coeffs().data()));
    columns.position.push_back(add(x.position_world_m[k].data()));
    columns.velocity.push_back(add(x.velocity_world_mps[k].data()));
    columns.bias.push_back(add(x.bias[k].data()));
  }
  columns.gravity = add(x.gravity_direction_world.data());
  columns.imu_camera_rotation = add(x.T_imu_camera.rotation.coeffs().data());
  columns.imu_camera_translation = add(x.T_imu_camera.translation.data());
  columns.time_offset = add(&x.time_offset_s);
  columns.gyroscope_scale = add(x.scales.gyroscope.data());
  columns.accelerometer_scale = add(x.scales.accelerometer.data());
  for (std::size_t i = 0; i < columns.timing.size(); ++i)
    columns.timing[i] = add(&x.timing_s[static_cast<Eigen::Index>(i)]);

  for (const auto* group : {&visual_, &inertial_, &timing_, &rest_})
    options.residual_blocks.insert(options.residual_blocks.end(), group->begin(), group->end());
  ceres::CRSMatrix jacobian;
  problem_.Evaluate(options, nullptr, &result.residuals, nullptr, &jacobian);
  const std::vector<SparseIndex> rows(jacobian.rows.begin(), jacobian.rows.end());
  const std::vector<SparseIndex> columns_of(jacobian.cols.begin(), jacobian.cols.end());
  result.jacobian = Eigen::Map<const SparseRowsd>(jacobian.num_rows, jacobian.num_cols,
                                                  static_cast<Eigen::Index>(jacobian.values.size()),
                                                  rows.data(), columns_of.data(), jacobian.values.data());
  return result;
}

Vector6d BatchProblem::visual_residual(std::size_t motion) const {
  Vector6d residual;
  problem_.EvaluateResidualBlock(visual_[motion], false, nullptr, residual.data(), nullptr);
  return residual;
}

}  // namespace fusebench::smoother
