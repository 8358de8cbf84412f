#include "core/estimator/places/pose_from_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "core/base/solvers.hpp"

namespace fusebench::places {

namespace {

/// Largest reprojection error of an inlier (pixels of the level of its feature): three standard deviations
/// of a corner.
constexpr double kInlierGate_px = 3.0;
/// Largest number of RANSAC draws: log(0.001) / log(1 - 0.25^3), for a quarter of inliers.
constexpr int kMaxDraws = 440;
/// Drawing ends when the probability that no draw had three inliers, given the current inlier share, is below
/// this.
constexpr double kFailureProbability = 0.001;
/// Rounds of refining the pose by its inliers and selecting them again.
constexpr int kRefinementRounds = 3;
/// Gauss-Newton steps of a round.
constexpr int kStepsPerRound = 5;
/// Threshold of the Huber norm of reprojection errors (pixels of the level): one standard deviation of a
/// corner.
constexpr double kHuber_px = 1.0;

// Twice the minimal three points, so that the redundancy shows the quality of the fit.
constexpr std::size_t kMinPoints = 6;

/// SplitMix64 (Steele et al., OOPSLA 2014).
struct Draws {
  std::uint64_t state = 0x9E3779B97F4A7C15ULL;
  std::size_t below(std::size_t count) {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<std::size_t>((z ^ (z >> 31)) % count);
  }
  std::array<std::size_t, 3> three_below(std::size_t count) {
    std::array<std::size_t, 3> drawn{below(count), below(count), below(count)};
    while (drawn[1] == drawn[0]) drawn[1] = below(count);
    while (drawn[2] == drawn[0] || drawn[2] == drawn[1]) drawn[2] = below(count);
    return drawn;
  }
};

/// Squared reprojection error of a point, in scales; infinite behind the camera.
double squared_error(const SeenPoint& seen, const SE3& T_camera_a, const PinholeCamera& camera) {
  constexpr double kMinDepth_m = 0.01;  // closer points project beyond all images
  const Vector3d point_camera = T_camera_a * seen.point_a;
  if (!(point_camera.z() > kMinDepth_m)) return std::numeric_limits<double>::infinity();
  return (camera.project(point_camera) - seen.pixel_px).squaredNorm() / (seen.scale * seen.scale);
}

/// Up to four poses T_camera_a for three points (P3P).
std::vector<SE3> poses_of_three(std::span<const SeenPoint> seen, const std::array<std::size_t, 3>& three,
                                const PinholeCamera& camera) {
  std::array<cv::Point3d, 3> points;
  std::array<cv::Point2d, 3> directions;
  for (std::size_t i = 0; i < 3; ++i) {
    const SeenPoint& s = seen[three[i]];
    const Vector3d ray = camera.back_project(s.pixel_px.x(), s.pixel_px.y(), 1.0);
    points[i] = {s.point_a.x(), s.point_a.y(), s.point_a.z()};
    directions[i] = {ray.x(), ray.y()};
  }
  std::vector<cv::Mat> rotations, translations;
  cv::solveP3P(points, directions, cv::Matx33d::eye(), cv::noArray(), rotations, translations,
               cv::SOLVEPNP_AP3P);
  std::vector<SE3> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Vector3d phi(rotations[i].at<double>(0), rotations[i].at<double>(1), rotations[i].at<double>(2));
    const Vector3d translation(translations[i].at<double>(0), translations[i].at<double>(1),
                               translations[i].at<double>(2));
    if (phi.allFinite() && translation.allFinite()) poses.push_back({so3_exp(phi), translation});
  }
  return poses;
}

/// Cost of a pose: an outlier costs as much as a point at the gate (MSAC, Torr and Zisserman 2000).
struct Score {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t inliers = 0;
};

Score score_of(std::span<const SeenPoint> seen, const SE3& T_camera_a, const PinholeCamera& camera,
               double gate_px) {
  Score score{0, 0};
  for (const SeenPoint& s : seen) {
    const double error = squared_error(s, T_camera_a, camera);
    const bool inlier = error < gate_px * gate_px;
    score.inliers += inlier ? 1 : 0;
    score.cost += inlier ? error : gate_px * gate_px;
  }
  return score;
}

/// Number of draws that reach the required probability at this inlier share.
int draws_needed(std::size_t inliers, std::size_t count) {
  const double share = static_cast<double>(inliers) / static_cast<double>(count);
  const double all_right = share * share * share;
  if (all_right > 1.0 - kFailureProbability) return 1;
  const double draws = std::ceil(std::log(kFailureProbability) / std::log1p(-all_right));
  return static_cast<int>(std::min(static_cast<double>(kMaxDraws), draws));
}

SE3 best_of_draws(std::span<const SeenPoint> seen, const PinholeCamera& camera) {
  Draws draws;
  SE3 best;
  Score best_score;
  int needed = kMaxDraws;
  for (int draw = 0; draw < needed; ++draw) {
    for (const SE3& pose : poses_of_three(seen, draws.three_below(seen.size()), camera)) {
      const Score score = score_of(seen, pose, camera, kInlierGate_px);
      if (score.cost >= best_score.cost) continue;
      best = pose;
      best_score = score;
      needed = draws_needed(score.inliers, seen.size());
    }
  }
  return best;
}

std::vector<std::size_t> inliers_of(std::span<const SeenPoint> seen, const SE3& T_camera_a,
                                    const PinholeCamera& camera, double gate_px) {
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (squared_error(seen[i], T_camera_a, camera) < gate_px * gate_px) inliers.push_back(i);
  }
  return inliers;
}

/// Normal equations of the inliers: rotation (on the right) and position in the camera axes.
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

/// Huber weights with a bound in scales.
NormalEquations normal_equations(std::span<const SeenPoint> seen, std::span<const std::size_t> inliers,
                                 const SE3& T_a_camera, const PinholeCamera& camera, double huber_px) {
  const SE3 T_camera_a = T_a_camera.inverse();
  NormalEquations sum;
  for (const std::size_t i : inliers) {
    const SeenPoint& s = seen[i];
    const Vector3d point_camera = T_camera_a * s.point_a;
    if (!(point_camera.z() > 0)) continue;
    const Vector2d residual = (camera.project(point_camera) - s.pixel_px) / s.scale;
    Eigen::Matrix<double, 3, 6> point_by_pose;
    point_by_pose << hat(point_camera), -Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> jacobian =
        camera.projection_jacobian(point_camera) * point_by_pose / s.scale;
    const double weight = huber_px / std::max(huber_px, residual.norm());
    sum.information += weight * jacobian.transpose() * jacobian;
    sum.gradient += weight * jacobian.transpose() * residual;
  }
  return sum;
}

SE3 stepped(std::span<const SeenPoint> seen, std::span<const std::size_t> inliers, const SE3& T_a_camera,
            const PinholeCamera& camera, double huber_px) {
  const NormalEquations sum = normal_equations(seen, inliers, T_a_camera, camera, huber_px);
  const Vector6d step = sum.information.ldlt().solve(Vector6d(-sum.gradient));
  if (!step.allFinite()) return T_a_camera;
  return T_a_camera * SE3{so3_exp(step.head<3>()), step.tail<3>()};
}

/// Sets the rms and the covariance of the pose from the scatter of the inliers.
void describe(std::span<const SeenPoint> seen, const PinholeCamera& camera, double huber_px,
              PoseFromPoints& result) {
  const SE3 T_camera_a = result.T_a_camera.inverse();
  double sum = 0;
  for (const std::size_t i : result.inliers) sum += squared_error(seen[i], T_camera_a, camera);
  const auto count = static_cast<double>(result.inliers.size());
  result.rms_px = std::sqrt(sum / count);
  const double variance = sum / (2 * count - 6);
  const NormalEquations equations =
      normal_equations(seen, result.inliers, result.T_a_camera, camera, huber_px);
  Matrix6d to_frame_a = Matrix6d::Identity();
  to_frame_a.bottomRightCorner<3, 3>() = result.T_a_camera.rotation_matrix();
  const Matrix6d in_camera = variance * equations.information.ldlt().solve(Matrix6d::Identity());
  result.covariance = to_frame_a * in_camera * to_frame_a.transpose();
}

}  // namespace

std::optional<PoseFromPoints> pose_from_points(std::span<const SeenPoint> seen, const PinholeCamera& camera) {
  if (seen.size() < kMinPoints) return std::nullopt;
  PoseFromPoints result;
  result.T_a_camera = best_of_draws(seen, camera).inverse();
  // A pose from three noisy points misses some inliers; each round finds more.
  for (int round = 0; round < kRefinementRounds; ++round) {
    result.inliers = inliers_of(seen, result.T_a_camera.inverse(), camera, kInlierGate_px);
    if (result.inliers.size() < kMinPoints) return std::nullopt;
    for (int step = 0; step < kStepsPerRound; ++step)
      result.T_a_camera = stepped(seen, result.inliers, result.T_a_camera, camera, kHuber_px);
  }
  result.inliers = inliers_of(seen, result.T_a_camera.inverse(), camera, kInlierGate_px);
  if (result.inliers.size() < kMinPoints) return std::nullopt;
  describe(seen, camera, kHuber_px, result);
  if (!result.covariance.allFinite()) return std::nullopt;
  return result;
}

}  // namespace fusebench::places
