#include "datasets/inspection/turn_alignment.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/inspection/order_statistics.hpp"

namespace fusebench {

namespace {

constexpr double kMaxOffset_s = 0.5;
constexpr std::size_t kMinIntervals = 8;
constexpr double kMinRate_radps = radians(3);
// A mirrored rotation must leave this share of the squared residual of a proper one: noise does not do that.
constexpr double kMirroredGain = 0.5;

struct Interval {
  double begin_s;
  double end_s;
  Vector3d camera_rad;
  double weight;
};

/// Best orthogonal matrix and bias for one offset.
struct Fit {
  double cost = 0;   ///< weighted sum of squares per interval, rad^2
  double total = 0;  ///< the gyroscope's own, about its mean rate
  double camera = 0;
  double weights = 0;
  Matrix3d rotation = Matrix3d::Identity();
  Vector3d bias_radps = Vector3d::Zero();
  Eigen::Vector3d singular_values = Eigen::Vector3d::Zero();
  double scale = 1;
};

struct Sums {
  Matrix3d cross = Matrix3d::Zero();
  Vector3d gyroscope_dt = Vector3d::Zero();
  Vector3d camera_dt = Vector3d::Zero();
  double gyroscope = 0, camera = 0, dt = 0, weights = 0;
};

Sums sums_at(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, double offset_s) {
  Sums s;
  for (const Interval& interval : intervals) {
    const auto turn = gyroscope.turn_rad(interval.begin_s + offset_s, interval.end_s + offset_s);
    if (!turn) continue;
    const double dt_s = interval.end_s - interval.begin_s;
    const double w = interval.weight;
    s.cross += w * *turn * interval.camera_rad.transpose();
    s.gyroscope_dt += w * dt_s * *turn;
    s.camera_dt += w * dt_s * interval.camera_rad;
    s.gyroscope += w * turn->squaredNorm();
    s.camera += w * interval.camera_rad.squaredNorm();
    s.dt += w * dt_s * dt_s;
    s.weights += w;
  }
  return s;
}

/// Wahba's problem with the bias eliminated: both sides are reduced by their part that is proportional to the
/// duration. The scale is not part of the residual: turns are compared after dividing by it.
Fit fit_at(const Sums& s, bool mirrored) {
  Fit fit;
  fit.weights = s.weights;
  if (s.dt <= 0) return fit;
  const Matrix3d cross = s.cross - s.gyroscope_dt * s.camera_dt.transpose() / s.dt;
  fit.total = s.gyroscope - s.gyroscope_dt.squaredNorm() / s.dt;
  fit.camera = s.camera - s.camera_dt.squaredNorm() / s.dt;
  const Eigen::JacobiSVD<Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() * (mirrored ? -1.0 : 1.0);
  const Vector3d signs(1, 1, sign > 0 ? 1.0 : -1.0);
  fit.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  fit.singular_values = svd.singularValues().cwiseProduct(signs);
  const double agreement = fit.singular_values.sum();
  fit.scale = fit.camera > 0 ? agreement / fit.camera : 1;
  fit.cost = fit.total - (fit.camera > 0 ? agreement * agreement / fit.camera : 0);
  if (agreement <= 0) fit.cost = fit.total;
  fit.bias_radps = (s.gyroscope_dt - fit.scale * (fit.rotation * s.camera_dt)) / s.dt;
  return fit;
}

/// The cost without which share of intervals happened to lie inside, normalised.
double relative_cost(const Fit& fit, std::size_t all) {
  if (fit.total <= 0 || fit.weights < 0.5 * static_cast<double>(all)) return 1;
  return fit.cost / fit.total;
}

struct OffsetSearch {
  double offset_s = 0;
  double cost = 1;
};

OffsetSearch search(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, bool mirrored,
                    double centre_s, double radius_s, double step_s) {
  OffsetSearch best{centre_s, 2};
  const int steps = static_cast<int>(std::lround(radius_s / step_s));
  for (int i = -steps; i <= steps; ++i) {
    const double offset_s = centre_s + i * step_s;
    const double cost =
        relative_cost(fit_at(sums_at(intervals, gyroscope, offset_s), mirrored), intervals.size());
    if (cost < best.cost) best = {offset_s, cost};
  }
  return best;
}

/// Minimum of the parabola through three costs; its curvature gives the uncertainty.
struct Vertex {
  double offset_s = 0;
  double curvature = 0;  ///< second derivative of the cost in rad^2
};

Vertex parabola(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, bool mirrored,
                double centre_s, double step_s) {
  const auto cost = [&](double offset_s) {
    return fit_at(sums_at(intervals, gyroscope, offset_s), mirrored).cost;
  };
  const double left = cost(centre_s - step_s), middle = cost(centre_s), right = cost(centre_s + step_s);
  const double second = (left - 2 * middle + right) / (step_s * step_s);
  if (second <= 0) return {centre_s, 0};
  const double shift_s = (left - right) / (2 * step_s * second);
  return {centre_s + std::clamp(shift_s, -step_s, step_s), second};
}

/// Huber weights of the residuals at a fit, with the scale from their median.
void reweight(std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, const Fit& fit,
              double offset_s) {
  std::vector<double> residuals;
  for (const Interval& interval : intervals) {
    const auto turn = gyroscope.turn_rad(interval.begin_s + offset_s, interval.end_s + offset_s);
    const double dt_s = interval.end_s - interval.begin_s;
    residuals.push_back(
        turn ? (*turn - fit.scale * (fit.rotation * interval.camera_rad) - dt_s * fit.bias_radps).norm() : 0);
  }
  const double limit = std::max(1e-6, 2.0 * median(residuals));
  for (std::size_t i = 0; i < intervals.size(); ++i)
    intervals[i].weight = residuals[i] <= limit ? 1.0 : limit / residuals[i];
}

std::vector<Interval> intervals_of(const CameraTurns& turns, const GyroscopeIntegral& gyroscope) {
  std::vector<Interval> result;
  for (const CameraTurn& turn : turns.turns) {
    const double begin_s = gyroscope.seconds(turn.begin_ns);
    const double end_s = gyroscope.seconds(turn.end_ns);
    // Within the gyroscope's time for every offset, so that all offsets compare the same intervals; a short
    // recording is allowed to lose some at its ends.
    if (gyroscope.turn_rad(begin_s, end_s)) result.push_back({begin_s, end_s, turn.turn_rad, 1.0});
  }
  return result;
}

double camera_rms(const std::vector<Interval>& intervals) {
  double sum = 0;
  for (const Interval& interval : intervals)
    sum += interval.camera_rad.squaredNorm() / std::pow(interval.end_s - interval.begin_s, 2);
  return intervals.empty() ? 0 : std::sqrt(sum / static_cast<double>(intervals.size()));
}

/// Standard deviation of the rotation about its least known axis: the information about an axis is the
/// turning across it.
double rotation_sigma(const std::vector<Interval>& intervals, double variance_rad2) {
  Matrix3d scatter = Matrix3d::Zero();
  for (const Interval& interval : intervals)
    scatter += interval.weight * interval.camera_rad * interval.camera_rad.transpose();
  const Matrix3d information = scatter.trace() * Matrix3d::Identity() - scatter;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(information);
  return std::sqrt(variance_rad2 / std::max(1e-12, solver.eigenvalues()[0]));
}

}  // namespace

std::optional<TurnAlignment> align_turns(const CameraTurns& turns, const GyroscopeIntegral& gyroscope) {
  std::vector<Interval> intervals = intervals_of(turns, gyroscope);
  TurnAlignment result;
  result.camera_rms_radps = camera_rms(intervals);
  if (intervals.size() < kMinIntervals || result.camera_rms_radps < kMinRate_radps) return std::nullopt;
  const OffsetSearch proper = search(intervals, gyroscope, false, 0, kMaxOffset_s, 0.01);
  const OffsetSearch mirror = search(intervals, gyroscope, true, 0, kMaxOffset_s, 0.01);
  const bool mirrored = mirror.cost < kMirroredGain * proper.cost;
  double offset_s = (mirrored ? mirror : proper).offset_s;
  for (int round = 0; round < 3; ++round) {
    reweight(intervals, gyroscope, fit_at(sums_at(intervals, gyroscope, offset_s), mirrored), offset_s);
    offset_s = search(intervals, gyroscope, mirrored, offset_s, 0.012, 0.002).offset_s;
    offset_s = parabola(intervals, gyroscope, mirrored, offset_s, 0.004).offset_s;
  }
  const Vertex vertex = parabola(intervals, gyroscope, mirrored, offset_s, 0.004);
  const Fit fit = fit_at(sums_at(intervals, gyroscope, vertex.offset_s), mirrored);
  const double freedom = std::max(1.0, 3 * fit.weights - 8);
  const double variance_rad2 = fit.cost / freedom;
  double dt_s = 0;
  for (const Interval& interval : intervals)
    dt_s += (interval.end_s - interval.begin_s) / static_cast<double>(intervals.size());
  result.intervals = intervals.size();
  result.time_offset_s = vertex.offset_s;
  result.time_offset_sigma_s =
      vertex.curvature > 0 ? std::sqrt(2 * variance_rad2 / vertex.curvature) : kMaxOffset_s;
  result.rotation_imu_camera = fit.rotation;
  result.rotation_sigma_rad = rotation_sigma(intervals, variance_rad2);
  result.scale = fit.scale;
  result.bias_radps = fit.bias_radps;
  result.residual_radps = std::sqrt(std::max(0.0, fit.cost) / std::max(1.0, fit.weights)) / dt_s;
  result.explained = fit.total > 0 ? 1 - fit.cost / fit.total : 0;
  return result;
}

}  // namespace fusebench
