#include "core/baselines/bundlefusion/pair_filters.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/solvers.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr double kMaxSquaredResidual_m2 = 4e-4;
constexpr double kMinSeparation_px = 5;
constexpr std::size_t kMinMatches = 5;
constexpr std::size_t kMaxRigidMatches = 25;
constexpr std::size_t kFewestToFit = 3;
constexpr double kMaxCondition = 100;
constexpr double kMinArea_m2 = 0.032;

/// Scatter of points: variances (square metres) along principal axes, ascending.
struct Scatter {
  Vector3d mean = Vector3d::Zero();
  Vector3d variances_m2 = Vector3d::Zero();
  Matrix3d axes = Matrix3d::Identity();
};

Scatter scatter_of(std::span<const Vector3d> points) {
  Scatter scatter;
  for (const Vector3d& point : points) scatter.mean += point;
  scatter.mean /= static_cast<double>(points.size());
  Matrix3d covariance = Matrix3d::Zero();
  for (const Vector3d& point : points)
    covariance += (point - scatter.mean) * (point - scatter.mean).transpose();
  covariance /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  scatter.variances_m2 = solver.eigenvalues();
  scatter.axes = solver.eigenvectors();
  return scatter;
}

/// The points of one frame of all pairs.
std::vector<Vector3d> side_of(std::span<const PointPair> points, Vector3d PointPair::*side) {
  std::vector<Vector3d> result;
  result.reserve(points.size());
  for (const PointPair& pair : points) result.push_back(pair.*side);
  return result;
}

/// True if the two largest variances show collinear points, which do not determine a motion. Coplanar points
/// do.
bool is_near_a_line(std::span<const Vector3d> points) {
  const Vector3d variances_m2 = scatter_of(points).variances_m2;
  return variances_m2(2) >= kMaxCondition * variances_m2(1);
}

bool is_near_one(const KeypointMatch& match, std::span<const KeypointMatch> taken, const Keypoints& a,
                 const Keypoints& b) {
  return std::ranges::any_of(taken, [&](const KeypointMatch& other) {
    return (a[match.a].pixel_px - a[other.a].pixel_px).norm() < kMinSeparation_px ||
           (b[match.b].pixel_px - b[other.b].pixel_px).norm() < kMinSeparation_px;
  });
}

/// Fits the motion and removes the worst pair until all agree or too few remain.
void drop_those_that_disagree(RigidMatches& rigid) {
  while (rigid.points.size() >= kFewestToFit) {
    rigid.T_a_b = rigid_fit(rigid.points);
    std::size_t worst = 0;
    double worst_m2 = 0;
    for (std::size_t i = 0; i < rigid.points.size(); ++i) {
      const auto& [point_a, point_b] = rigid.points[i];
      const double residual_m2 = (point_a - rigid.T_a_b * point_b).squaredNorm();
      if (residual_m2 <= worst_m2) continue;
      worst = i;
      worst_m2 = residual_m2;
    }
    if (worst_m2 < kMaxSquaredResidual_m2) return;
    rigid.points.erase(rigid.points.begin() + static_cast<std::ptrdiff_t>(worst));
    rigid.matches.erase(rigid.matches.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

}  // namespace

SE3 rigid_fit(std::span<const PointPair> points) {
  Eigen::Matrix3Xd a(3, points.size());
  Eigen::Matrix3Xd b(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    a.col(column) = points[i].point_a;
    b.col(column) = points[i].point_b;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(b, a, false);
  const Matrix3d R = T.topLeftCorner<3, 3>();
  return {Quaterniond(R).normalized(), T.topRightCorner<3, 1>()};
}

std::optional<RigidMatches> filter_by_motion(std::span<const KeypointMatch> matches, const Keypoints& a,
                                             const Keypoints& b) {
  RigidMatches rigid;
  for (const KeypointMatch& match : matches) {
    if (rigid.matches.size() == kMaxRigidMatches) break;
    if (is_near_one(match, rigid.matches, a, b)) continue;
    rigid.matches.push_back(match);
    rigid.points.push_back({a[match.a].point_camera, b[match.b].point_camera});
    drop_those_that_disagree(rigid);
  }
  if (rigid.matches.size() < kMinMatches) return std::nullopt;
  if (is_near_a_line(side_of(rigid.points, &PointPair::point_a)) ||
      is_near_a_line(side_of(rigid.points, &PointPair::point_b)))
    return std::nullopt;
  return rigid;
}

double box_area_m2(std::span<const Vector3d> points) {
  if (points.empty()) return 0;
  const Scatter scatter = scatter_of(points);
  double area_m2 = 1;
  for (const Eigen::Index axis : {1, 2}) {
    double least_m = 0;
    double greatest_m = 0;
    for (const Vector3d& point : points) {
      const double along_m = scatter.axes.col(axis).dot(point - scatter.mean);
      least_m = std::min(least_m, along_m);
      greatest_m = std::max(greatest_m, along_m);
    }
    area_m2 *= greatest_m - least_m;
  }
  return area_m2;
}

bool covers_enough_area(std::span<const PointPair> points) {
  return box_area_m2(side_of(points, &PointPair::point_a)) >= kMinArea_m2 &&
         box_area_m2(side_of(points, &PointPair::point_b)) >= kMinArea_m2;
}

}  // namespace fusebench::baselines::bundlefusion
