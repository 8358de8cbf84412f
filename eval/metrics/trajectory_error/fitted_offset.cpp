#include "eval/metrics/trajectory_error/fitted_offset.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/geometry.hpp"
#include "eval/metrics/trajectory_error/alignment.hpp"

namespace fusebench::trajectory_error {

namespace {

constexpr int kIterations = 20;
constexpr int kSize = 9;  // rotation, translation, offset
/// Files of trajectories have as many decimals: a copy without any error does not tell more than they do.
constexpr double kRounding_m = 1e-4;
using Vector9d = Eigen::Matrix<double, kSize, 1>;
using Matrix9d = Eigen::Matrix<double, kSize, kSize>;

struct Pair {
  SE3 reference;
  Vector3d estimate;
};

struct NormalEquations {
  Matrix9d information = Matrix9d::Zero();
  Vector9d gradient = Vector9d::Zero();
  double squares = 0;
};

Vector3d residual(const Pair& pair, const FittedOffset& fit) {
  return pair.reference * fit.offset_m - fit.T_reference_estimate * pair.estimate;
}

NormalEquations linearised(const std::vector<Pair>& pairs, const FittedOffset& fit) {
  NormalEquations sum;
  for (const Pair& pair : pairs) {
    const Vector3d r = residual(pair, fit);
    Eigen::Matrix<double, 3, kSize> jacobian;
    // Rotation of the alignment on the left: R p moves by phi x R p.
    jacobian.leftCols<3>() = hat(fit.T_reference_estimate.rotation * pair.estimate);
    jacobian.middleCols<3>(3) = -Matrix3d::Identity();
    jacobian.rightCols<3>() = pair.reference.rotation_matrix();
    sum.information += jacobian.transpose() * jacobian;
    sum.gradient += jacobian.transpose() * r;
    sum.squares += r.squaredNorm();
  }
  return sum;
}

/// From no offset and the alignment that belongs to it.
FittedOffset least_squares(const std::vector<Pair>& pairs, const SE3& T_reference_estimate,
                           double duration_s) {
  FittedOffset fit;
  fit.pairs = pairs.size();
  fit.T_reference_estimate = T_reference_estimate;
  // A weak pull towards no offset keeps directions that nothing tells from running away.
  Matrix9d pull = Matrix9d::Zero();
  pull.diagonal().tail<3>().setConstant(1e-9 * static_cast<double>(pairs.size()));
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const NormalEquations normal = linearised(pairs, fit);
    const Vector9d step = (normal.information + pull).ldlt().solve(-normal.gradient);
    fit.T_reference_estimate.rotation =
        (so3_exp(step.head<3>()) * fit.T_reference_estimate.rotation).normalized();
    fit.T_reference_estimate.translation += step.segment<3>(3);
    fit.offset_m += step.tail<3>();
    if (step.norm() < 1e-12) break;
  }
  const NormalEquations at = linearised(pairs, fit);
  const auto count = static_cast<double>(pairs.size());
  const double independent = std::clamp(duration_s, 1.0, count);
  const double scatter_m2 =
      std::max(at.squares / std::max(1.0, 3.0 * count - kSize), kRounding_m * kRounding_m);
  const double variance_m2 = scatter_m2 * (count / independent);
  const Matrix9d covariance = (at.information + pull).ldlt().solve(Matrix9d::Identity());
  fit.covariance_m2 = variance_m2 * covariance.bottomRightCorner<3, 3>();
  return fit;
}

}  // namespace

Result<FittedOffset> fitted_offset(const trajectory_files::TrajectoryPair& pair) {
  std::vector<Pair> pairs;
  std::vector<Vector3d> truth_m;
  std::vector<Vector3d> estimate_m;
  for (std::size_t i = 0; i < pair.size(); ++i) {
    pairs.push_back({pair.reference[i].T_world_camera, pair.estimate[i].T_world_camera.translation});
    truth_m.push_back(pairs.back().reference.translation);
    estimate_m.push_back(pairs.back().estimate);
  }
  const auto without_offset = align_positions(truth_m, estimate_m, false);
  if (!without_offset) return tl::unexpected(without_offset.error());
  // Relative to a position of each side, which keeps the digits of positions far from the origin.
  const Vector3d& centre = without_offset->centre;
  const Vector3d& image = without_offset->image;
  for (Pair& each : pairs) {
    each.reference.translation -= image;
    each.estimate -= centre;
  }
  const double duration_s =
      seconds_between(pair.estimate.front().timestamp_ns, pair.estimate.back().timestamp_ns);
  FittedOffset fit =
      least_squares(pairs, {without_offset->rigid.rotation, without_offset->shift}, duration_s);
  const double sigma_m = largest_sigma(fit.covariance_m2);
  if (!(sigma_m <= kMaxOffsetSigma_m)) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("the motion does not tell an offset of the body: one standard deviation is {:.3f} m, "
                    "allowed is {} m",
                    sigma_m, kMaxOffsetSigma_m));
  }
  for (const Pair& each : pairs) fit.errors_m.push_back(residual(each, fit).norm());
  fit.stats = metrics::statistics(fit.errors_m);
  fit.T_reference_estimate.translation += image - fit.T_reference_estimate.rotation * centre;
  return fit;
}

Result<FittedOffset> fitted_offset(const Trajectory& ground_truth, const Trajectory& estimate,
                                   const AteOptions& options) {
  const auto associated = associated_poses(ground_truth, estimate, options);
  if (!associated) return tl::unexpected(associated.error());
  trajectory_files::TrajectoryPair pair;
  for (const trajectory::AssociatedPair& indices : *associated) {
    pair.reference.push_back(ground_truth[indices.first]);
    pair.estimate.push_back(estimate[indices.second]);
  }
  return fitted_offset(pair);
}

}  // namespace fusebench::trajectory_error
