#include "core/estimator/places/dense_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/solvers.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/estimator/places/small_images.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::places {

namespace {

constexpr int kNormalReach = 3;        // small pixels to either side, for a normal
constexpr double kMostBend_m = 0.003;  // largest deviation from a plane, in addition to noise
constexpr double kBendSigmas = 2.0;
constexpr int kPointStep = 2;         // every second pixel of the query in both directions
constexpr double kHuberSigmas = 1.5;  // larger residuals are down-weighted (Huber 1964)

/// The depth of a place as planes, for each pixel of the small image.
class Surface {
 public:
  struct Plane {
    Vector3d point = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();  ///< unit; zero: none
  };

  Surface(const DepthImage& depth_m, const PinholeCamera& camera, const config::DepthConfig& config)
      : camera_(camera), planes_(depth_m.width, depth_m.height) {
    for (int y = kNormalReach; y + kNormalReach < depth_m.height; ++y) {
      for (int x = kNormalReach; x + kNormalReach < depth_m.width; ++x) {
        if (bends(depth_m, x, y, kNormalReach, 0, config) || bends(depth_m, x, y, 0, kNormalReach, config))
          continue;
        const auto point = [&](int u, int v) { return point_at(depth_m, u, v, camera); };
        const Vector3d across = point(x + kNormalReach, y) - point(x - kNormalReach, y);
        const Vector3d down = point(x, y + kNormalReach) - point(x, y - kNormalReach);
        planes_(x, y) = {point(x, y), across.cross(down).normalized()};
      }
    }
  }

  /// Plane at the projection of the point; null if there is none.
  [[nodiscard]] const Plane* at(const Vector3d& point_camera) const {
    const auto pixel = pixel_of(point_camera, camera_, planes_);
    if (!pixel || planes_(pixel->x, pixel->y).normal.isZero()) return nullptr;
    return &planes_(pixel->x, pixel->y);
  }

 private:
  /// True if depth is missing or not planar. Inverse depth is linear in the image on a plane, but not across
  /// an edge or a corner of the room.
  static bool bends(const DepthImage& depth_m, int x, int y, int dx, int dy,
                    const config::DepthConfig& config) {
    const auto before_m = static_cast<double>(depth_m(x - dx, y - dy));
    const auto here_m = static_cast<double>(depth_m(x, y));
    const auto after_m = static_cast<double>(depth_m(x + dx, y + dy));
    if (!(before_m > 0 && here_m > 0 && after_m > 0)) return true;
    const double expected_m = 2.0 / (1.0 / before_m + 1.0 / after_m);
    return std::abs(here_m - expected_m) >
           kMostBend_m + kBendSigmas * preprocessing::depth_sigma_m(here_m, config);
  }

  const PinholeCamera& camera_;
  Image<Plane> planes_;
};

/// Number of points of an image without holes.
double most_points(const DepthImage& depth_m) {
  const auto every_other = [](int pixels) { return (pixels + kPointStep - 1) / kPointStep; };
  return static_cast<double>(every_other(depth_m.width) * every_other(depth_m.height));
}

std::vector<Vector3d> points_of(const DepthImage& depth_m, const PinholeCamera& camera) {
  std::vector<Vector3d> points;
  for (int y = 0; y < depth_m.height; y += kPointStep) {
    for (int x = 0; x < depth_m.width; x += kPointStep) {
      if (depth_m(x, y) > 0) points.push_back(point_at(depth_m, x, y, camera));
    }
  }
  return points;
}

/// Normal equations of the point-to-plane distances, each divided by its standard deviation.
struct DepthSums {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double squared = 0;  ///< weighted
  double weights = 0;
  int pairs = 0;

  /// Variance factor: at least 1, larger if the residuals exceed their noise.
  [[nodiscard]] double variance() const { return weights > 0 ? std::max(1.0, squared / weights) : 1.0; }
};

DepthSums sums_at(const SE3& T_known_query, const std::vector<Vector3d>& points_query, const Surface& surface,
                  double gate_m, const config::DepthConfig& config) {
  DepthSums sums;
  const Matrix3d R = T_known_query.rotation_matrix();
  for (const Vector3d& point_query : points_query) {
    const Vector3d point = R * point_query + T_known_query.translation;
    const Surface::Plane* const plane = surface.at(point);
    if (plane == nullptr || (point - plane->point).squaredNorm() > gate_m * gate_m) continue;
    const double sigma_m = std::hypot(preprocessing::depth_sigma_m(point_query.z(), config),
                                      preprocessing::depth_sigma_m(plane->point.z(), config));
    const double residual = plane->normal.dot(point - plane->point) / sigma_m;
    const double weight = std::min(1.0, kHuberSigmas / std::max(std::abs(residual), 1e-12));
    Vector6d jacobian;
    jacobian << point_query.cross(R.transpose() * plane->normal), plane->normal;
    jacobian /= sigma_m;
    sums.information += weight * jacobian * jacobian.transpose();
    sums.gradient += weight * residual * jacobian;
    sums.squared += weight * residual * residual;
    sums.weights += weight;
    ++sums.pairs;
  }
  return sums;
}

constexpr int kStepsOfGate = 6;

/// Gates from reach_m, halved at each step, to a quarter of narrow_m. The last one has twice the number of
/// steps.
std::vector<double> narrowing_gates_m(double reach_m, double narrow_m) {
  const double last_m = 0.25 * narrow_m;
  std::vector<double> gates_m;
  for (double gate_m = std::max(reach_m, narrow_m); gate_m > last_m; gate_m *= 0.5) gates_m.push_back(gate_m);
  gates_m.insert(gates_m.end(), 2, last_m);
  return gates_m;
}

}  // namespace

std::optional<RelativePose> aligned_by_depth(const SmallImages& known, const SmallImages& query,
                                             const AlignmentStart& start, const PinholeCamera& camera,
                                             const config::DepthConfig& depth,
                                             const config::LoopsConfig& loops) {
  constexpr double kLastStep = 1e-5;  // rad and m
  const double most_pairs = most_points(query.depth_m);
  const Surface surface(known.depth_m, camera, depth);
  const std::vector<Vector3d> points_query = points_of(query.depth_m, camera);
  const Matrix6d prior = start.from_features
                             ? Matrix6d(start.pose.covariance.ldlt().solve(Matrix6d::Identity()))
                             : Matrix6d::Zero();
  SE3 pose = start.pose.T_known_query;
  Matrix6d information = Matrix6d::Zero();
  for (const double gate_m : narrowing_gates_m(start.reach_m, loops.dense_gate_m)) {
    for (int step = 0; step < kStepsOfGate; ++step) {
      const DepthSums sums = sums_at(pose, points_query, surface, gate_m, depth);
      if (sums.pairs < loops.dense_min_share * most_pairs) return std::nullopt;
      const double share = loops.dense_measurements / (sums.variance() * most_pairs);
      information = share * sums.information + prior;
      const Vector6d gradient = share * sums.gradient + prior * pose_minus(pose, start.pose.T_known_query);
      const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
      if (!(eigen.eigenvalues().minCoeff() > 1e-12 * eigen.eigenvalues().maxCoeff())) return std::nullopt;
      const Vector6d move = -information.ldlt().solve(gradient);
      pose = pose_plus(pose, move);
      if (move.cwiseAbs().maxCoeff() < kLastStep) break;
    }
  }
  const Matrix6d covariance = information.ldlt().solve(Matrix6d::Identity());
  return RelativePose{pose, 0.5 * (covariance + covariance.transpose())};
}

}  // namespace fusebench::places
