#include "eval/run/preparation/timing_pair.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/upper_median.hpp"
#include "datasets/inspection/measures/frame_warp.hpp"

namespace fusebench::preparation {

namespace {

// Unknowns of a pair: pose of the second frame (rotation, position in its axes), gain, offset.
constexpr int kPair = 8;
constexpr int kAll = kPair + 3;
using Row = Eigen::Matrix<double, kAll, 1>;
using Normal = Eigen::Matrix<double, kAll, kAll>;

constexpr int kPointsAcross = 48;
constexpr std::size_t kFewestPoints = 200;
constexpr int kIterations = 3;
constexpr double kHuberSigmas = 1.5;
constexpr double kMaxPlaneDistance_m = 0.1;

/// A point of the first frame.
struct Point {
  Vector3d in_camera;
  double row = 0;  ///< from the middle, as a share of the image's height
  double grey = 0;
};

double row_share(double y_px, int height_px) { return y_px / (height_px - 1) - 0.5; }

std::vector<Point> points_of(const RgbdFrame& frame, const PinholeCamera& camera) {
  constexpr int kNeighbour_px = 2;
  const int step = std::max(kNeighbour_px, camera.width_px / kPointsAcross);
  std::vector<Point> points;
  for (int y = step; y + step < camera.height_px; y += step) {
    for (int x = step; x + step < camera.width_px; x += step) {
      if (!inspection::measures::is_smooth(frame.depth_m, x, y)) continue;
      points.push_back({camera.back_project(x, y, static_cast<double>(frame.depth_m(x, y))),
                        row_share(y, camera.height_px), static_cast<double>(frame.grey(x, y))});
    }
  }
  return points;
}

SE3 exp_of(const Vector6d& twist, double time_s) {
  return {so3_exp(twist.head<3>() * time_s), twist.tail<3>() * time_s};
}

/// Velocity of a point that is at rest, against axes that move.
Vector3d velocity_at(const Vector6d& twist, const Vector3d& point) {
  return twist.tail<3>() + twist.head<3>().cross(point);
}

/// A point of the first frame in the second one.
struct Warped {
  Vector3d point;  ///< in the camera at the instant of its row
  Vector2d pixel;
  double row = 0;      ///< as of Point
  Vector3d by_time_a;  ///< derivative of the point by the instant of its row in the first frame
  Vector3d by_time_b;  ///< the same in the second
};

class Warp {
 public:
  Warp(const Vector6d& twist_a, const Vector6d& twist_b, const PinholeCamera& camera, double readout_s,
       const Vector2d& delays_s)
      : twist_a_(twist_a), twist_b_(twist_b), camera_(camera), readout_s_(readout_s), delays_s_(delays_s) {}

  [[nodiscard]] std::optional<Warped> operator()(const Point& point, const SE3& T_b_a) const {
    constexpr int kRowIterations = 2;
    const SE3 moved_a = exp_of(twist_a_, delays_s_[0] + readout_s_ * point.row);
    const Vector3d at_instant = T_b_a * (moved_a * point.in_camera);
    Warped warped;
    warped.row = point.row;
    for (int i = 0; i < kRowIterations; ++i) {
      warped.point = exp_of(twist_b_, delays_s_[1] + readout_s_ * warped.row).inverse() * at_instant;
      if (warped.point.z() < 0.1) return std::nullopt;
      warped.pixel = camera_.project(warped.point);
      if (!(warped.pixel.x() >= 2 && warped.pixel.y() >= 2 && warped.pixel.x() < camera_.width_px - 3 &&
            warped.pixel.y() < camera_.height_px - 3))
        return std::nullopt;
      warped.row = row_share(warped.pixel.y(), camera_.height_px);
    }
    warped.by_time_a = T_b_a.rotation * velocity_at(twist_a_, point.in_camera);
    warped.by_time_b = -velocity_at(twist_b_, warped.point);
    return warped;
  }

 private:
  const Vector6d& twist_a_;
  const Vector6d& twist_b_;
  const PinholeCamera& camera_;
  double readout_s_;
  Vector2d delays_s_;  ///< of the images behind the instants of their frames
};

/// Residuals of one kind, with their derivatives.
struct Residuals {
  std::vector<double> values;
  std::vector<Row> rows;

  void add(double value, const Row& row) {
    values.push_back(value);
    rows.push_back(row);
  }
};

/// Adds robust normal equations, whitened by the median of the residuals.
void add_normal(const Residuals& residuals, double least_sigma, Normal& normal, Row& gradient) {
  std::vector<double> sizes;
  sizes.reserve(residuals.values.size());
  for (const double value : residuals.values) sizes.push_back(std::abs(value));
  const double sigma = std::max(least_sigma, 1.4826 * upper_median(std::move(sizes)));
  for (std::size_t i = 0; i < residuals.values.size(); ++i) {
    const double whitened = std::abs(residuals.values[i]) / sigma;
    const double weight = (whitened <= kHuberSigmas ? 1.0 : kHuberSigmas / whitened) / (sigma * sigma);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(residuals.rows[i], weight);
    gradient += weight * residuals.values[i] * residuals.rows[i];
  }
}

/// Derivative of the warped point by the pose of the second frame.
Eigen::Matrix<double, 3, 6> by_pose(const Vector3d& point) {
  Eigen::Matrix<double, 3, 6> derivative;
  derivative << -hat(point), Matrix3d::Identity();
  return derivative;
}

/// Normal of the measured surface around a pixel, towards the camera; nothing if it is not smooth.
std::optional<Vector3d> normal_at(const DepthImage& depth_m, const PinholeCamera& camera, int x, int y) {
  constexpr int kNeighbour_px = 2;
  if (!inspection::measures::is_smooth(depth_m, x, y)) return std::nullopt;
  const auto point = [&](int u, int v) {
    return camera.back_project(u, v, static_cast<double>(depth_m(u, v)));
  };
  const Vector3d across = point(x + kNeighbour_px, y) - point(x - kNeighbour_px, y);
  const Vector3d down = point(x, y + kNeighbour_px) - point(x, y - kNeighbour_px);
  return down.cross(across).normalized();
}

Residuals grey_residuals(const std::vector<Point>& points, const Warp& warp, const SE3& T_b_a,
                         const MovingFrame& b, const PinholeCamera& camera, const Vector2d& brightness) {
  Residuals residuals;
  for (const Point& point : points) {
    const auto warped = warp(point, T_b_a);
    if (!warped) continue;
    const IntensitySample sample = sample_bilinear(b.frame.grey, warped->pixel.x(), warped->pixel.y());
    const Eigen::RowVector3d by_point =
        Eigen::RowVector2d(sample.dx, sample.dy) * camera.projection_jacobian(warped->point);
    Row row = Row::Zero();
    row.head<6>() = (by_point * by_pose(warped->point)).transpose();
    row[6] = -point.grey;
    row[7] = -1;
    row[8] = by_point.dot(point.row * warped->by_time_a + warped->row * warped->by_time_b);
    residuals.add(sample.value - (brightness[0] * point.grey + brightness[1]), row);
  }
  return residuals;
}

Residuals depth_residuals(const std::vector<Point>& points, const Warp& warp, const SE3& T_b_a,
                          const MovingFrame& b, const PinholeCamera& camera) {
  Residuals residuals;
  for (const Point& point : points) {
    const auto warped = warp(point, T_b_a);
    if (!warped) continue;
    const auto x = static_cast<int>(std::lround(warped->pixel.x()));
    const auto y = static_cast<int>(std::lround(warped->pixel.y()));
    const auto normal = normal_at(b.frame.depth_m, camera, x, y);
    if (!normal) continue;
    const Vector3d measured = camera.back_project(x, y, static_cast<double>(b.frame.depth_m(x, y)));
    const double distance_m = normal->dot(warped->point - measured);
    if (std::abs(distance_m) > kMaxPlaneDistance_m) continue;
    // Depth noise grows with the square of the depth.
    const double scale = 1 / std::max(0.5, measured.z() * measured.z());
    Row row = Row::Zero();
    row.head<6>() = scale * (normal->transpose() * by_pose(warped->point)).transpose();
    const Vector3d by_row = point.row * warped->by_time_a + warped->row * warped->by_time_b;
    row[9] = scale * normal->dot(by_row);
    row[10] = scale * normal->dot(warped->by_time_a + warped->by_time_b);
    residuals.add(scale * distance_m, row);
  }
  return residuals;
}

}  // namespace

std::optional<TimingQuadratic> timing_of_pair(const MovingFrame& a, const MovingFrame& b,
                                              const PinholeCamera& camera, const Vector3d& timing_s) {
  constexpr double kLeastGreySigma = 2.0;
  constexpr double kLeastDepthSigma_m = 0.001;
  constexpr double kConvergedStep = 1e-4;  // rad, m: 0.03 px
  const std::vector<Point> points = points_of(a.frame, camera);
  const Warp color_warp(a.motion->twist, b.motion->twist, camera, timing_s[0], Vector2d::Zero());
  const Vector2d delays_s(timing_s[2] + 1e-9 * static_cast<double>(a.frame.depth_offset_ns),
                          timing_s[2] + 1e-9 * static_cast<double>(b.frame.depth_offset_ns));
  const Warp depth_warp(a.motion->twist, b.motion->twist, camera, timing_s[1], delays_s);
  SE3 T_b_a = b.motion->T_world_camera.inverse() * a.motion->T_world_camera;
  Vector2d brightness(1, 0);
  Normal normal;
  Row gradient;
  bool is_last = false;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    normal.setZero();
    gradient.setZero();
    const Residuals grey = grey_residuals(points, color_warp, T_b_a, b, camera, brightness);
    const Residuals depth = depth_residuals(points, depth_warp, T_b_a, b, camera);
    if (grey.values.size() < kFewestPoints || depth.values.size() < kFewestPoints) return std::nullopt;
    add_normal(grey, kLeastGreySigma, normal, gradient);
    add_normal(depth, kLeastDepthSigma_m, normal, gradient);
    normal = Normal(normal.selfadjointView<Eigen::Lower>());
    if (is_last || iteration == kIterations) break;
    const Eigen::Matrix<double, kPair, 1> step =
        -normal.topLeftCorner<kPair, kPair>().ldlt().solve(gradient.head<kPair>());
    if (!step.allFinite()) return std::nullopt;
    T_b_a = SE3{so3_exp(step.head<3>()), step.segment<3>(3)} * T_b_a;
    brightness += step.tail<2>();
    is_last = step.head<6>().norm() < kConvergedStep;
  }
  const Eigen::Matrix<double, kPair, 3> eliminated =
      normal.topLeftCorner<kPair, kPair>().ldlt().solve(normal.topRightCorner<kPair, 3>());
  TimingQuadratic result;
  result.information = normal.bottomRightCorner<3, 3>() - normal.bottomLeftCorner<3, kPair>() * eliminated;
  result.gradient = gradient.tail<3>() - eliminated.transpose() * gradient.head<kPair>();
  return result;
}

}  // namespace fusebench::preparation
