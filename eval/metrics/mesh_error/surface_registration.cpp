#include "eval/metrics/mesh_error/surface_registration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"

namespace fusebench::mesh_error {

namespace {

constexpr std::size_t kPairsPerChunk = 1024;
// Of the strongest direction. A slide over a surface that is flat but for noise is no information.
constexpr double kFreeDirection = 1e-6;

/// A point, its distance to the surface, and the direction in which the distance grows.
struct Match {
  Vector3d point = Vector3d::Zero();
  Vector3d away = Vector3d::Zero();
  double distance_m = 0;
};

std::vector<Match> matches_of(std::span<const Vector3d> points, const TriangleTree& surface, const SE3& pose,
                              const Workers& workers) {
  std::vector<Match> matches(points.size());
  workers.for_chunks(points.size(), kPairsPerChunk, [&](std::size_t begin, std::size_t end) {
    NearestTriangle nearest;
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3d point = pose * points[i];
      nearest = surface.nearest(point, nearest);
      const Vector3d from_surface = point - surface.closest_point(point, nearest.place);
      const double distance_m = from_surface.norm();
      constexpr double kOnSurface_m = 1e-9;  // rounding has no direction
      matches[i] = {
          point,
          distance_m > kOnSurface_m ? Vector3d(from_surface / distance_m) : surface.normal(nearest.place),
          distance_m};
    }
  });
  return matches;
}

/// Keeps the nearest share, in the order of the points.
void trim(std::vector<Match>& matches, double kept) {
  std::vector<double> distances;
  distances.reserve(matches.size());
  for (const Match& match : matches) distances.push_back(match.distance_m);
  const auto count = static_cast<std::size_t>(std::ceil(kept * static_cast<double>(matches.size())));
  const auto limit = distances.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::ranges::nth_element(distances, limit);
  std::erase_if(matches, [limit_m = *limit](const Match& match) { return match.distance_m > limit_m; });
}

/// Turn and shift about the centre of the points that reduce their distances, in the directions that the
/// points determine.
struct Step {
  Vector3d center = Vector3d::Zero();
  double radius_m = 0;
  Vector6d move = Vector6d::Zero();  ///< turn times radius, shift: metres
  int free_directions = 0;
};

Step step_of(const std::vector<Match>& matches) {
  Step step;
  for (const Match& match : matches) step.center += match.point;
  step.center /= static_cast<double>(matches.size());
  for (const Match& match : matches) step.radius_m += (match.point - step.center).squaredNorm();
  step.radius_m = std::sqrt(step.radius_m / static_cast<double>(matches.size()));
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  for (const Match& match : matches) {
    Vector6d jacobian;
    jacobian << (match.point - step.center).cross(match.away) / step.radius_m, match.away;
    H += jacobian * jacobian.transpose();
    g += jacobian * match.distance_m;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(H);
  const double strongest = eigen.eigenvalues()[5];
  for (int k = 0; k < 6; ++k) {
    if (!(eigen.eigenvalues()[k] > kFreeDirection * strongest)) {
      ++step.free_directions;
      continue;
    }
    const Vector6d direction = eigen.eigenvectors().col(k);
    step.move -= direction.dot(g) / eigen.eigenvalues()[k] * direction;
  }
  return step;
}

SE3 moved(const SE3& pose, const Step& step) {
  const Quaterniond turn = so3_exp(step.move.head<3>() / step.radius_m);
  return {(turn * pose.rotation).normalized(),
          turn * (pose.translation - step.center) + step.center + step.move.tail<3>()};
}

double rms_of(const std::vector<Match>& matches) {
  double sum = 0;
  for (const Match& match : matches) sum += match.distance_m * match.distance_m;
  return std::sqrt(sum / static_cast<double>(matches.size()));
}

}  // namespace

Result<RegistrationResult> register_points(std::span<const Vector3d> points, const TriangleTree& surface,
                                           const SE3& T_surface_points, const RegistrationOptions& options,
                                           const Workers& workers) {
  constexpr std::size_t kFewest = 6;
  if (!(options.kept > 0 && options.kept <= 1))
    return fail(ErrorCode::usage,
                fmt::format("a share of {} of the points (allowed: above 0, up to 1)", options.kept));
  if (static_cast<double>(points.size()) * options.kept < static_cast<double>(kFewest)) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{} points are too few to move onto a surface", points.size()));
  }
  RegistrationResult result;
  result.T_surface_points = T_surface_points;
  while (result.steps < options.max_steps && !result.converged) {
    std::vector<Match> matches = matches_of(points, surface, result.T_surface_points, workers);
    trim(matches, options.kept);
    result.kept_rms_m = rms_of(matches);
    const Step step = step_of(matches);
    if (!(step.radius_m > 0))
      return fail(ErrorCode::data_corrupt, "the points to move onto the surface are all in one place");
    result.T_surface_points = moved(result.T_surface_points, step);
    result.free_directions = step.free_directions;
    ++result.steps;
    result.converged = step.move.norm() < options.converged_m;
  }
  return result;
}

}  // namespace fusebench::mesh_error
