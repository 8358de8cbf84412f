#include "datasets/inspection/measures/turn_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/solvers.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection::measures {

namespace {

constexpr double kMaxOffset_s = 0.5;
constexpr double kOffsetStep_s = 0.01;
constexpr std::size_t kMinIntervals = 8;
constexpr double kMinRate_radps = radians(3);
// A mirrored rotation must leave this share of the squared residual of a proper one: noise does not do that.
constexpr double kMirroredGain = 0.5;
constexpr double kGross = 10;  // residuals beyond this many limits of Huber's weights: twenty medians

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
  Matrix3d cross = Matrix3d::Zero();
  double scale = 1;
};

struct Sums {
  Matrix3d cross = Matrix3d::Zero();
  Vector3d gyroscope_dt = Vector3d::Zero();
  Vector3d camera_dt = Vector3d::Zero();
  double gyroscope = 0, camera = 0, dt = 0, weights = 0;
};

/// Rates beyond which turns are shortened: a single wrong one must not outweigh all others.
struct RateLimits {
  double gyroscope_radps = std::numeric_limits<double>::infinity();
  double camera_radps = std::numeric_limits<double>::infinity();
};

Vector3d shortened(const Vector3d& turn_rad, double most_rad) {
  const double angle_rad = turn_rad.norm();
  return angle_rad > most_rad ? Vector3d(most_rad / angle_rad * turn_rad) : turn_rad;
}

Sums sums_at(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, double offset_s,
             const RateLimits& limits = {}) {
  Sums s;
  for (const Interval& interval : intervals) {
    const auto whole = gyroscope.turn_rad(interval.begin_s + offset_s, interval.end_s + offset_s);
    if (!whole) continue;
    const double dt_s = interval.end_s - interval.begin_s;
    const Vector3d turn = shortened(*whole, dt_s * limits.gyroscope_radps);
    const Vector3d camera = shortened(interval.camera_rad, dt_s * limits.camera_radps);
    const double w = interval.weight;
    s.cross += w * turn * camera.transpose();
    s.gyroscope_dt += w * dt_s * turn;
    s.camera_dt += w * dt_s * camera;
    s.gyroscope += w * turn.squaredNorm();
    s.camera += w * camera.squaredNorm();
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
  fit.cross = s.cross - s.gyroscope_dt * s.camera_dt.transpose() / s.dt;
  fit.total = s.gyroscope - s.gyroscope_dt.squaredNorm() / s.dt;
  fit.camera = s.camera - s.camera_dt.squaredNorm() / s.dt;
  const Eigen::JacobiSVD<Matrix3d> svd(fit.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() * (mirrored ? -1.0 : 1.0);
  const Vector3d signs(1, 1, sign > 0 ? 1.0 : -1.0);
  fit.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const double agreement = svd.singularValues().cwiseProduct(signs).sum();
  fit.scale = fit.camera > 0 ? agreement / fit.camera : 1;
  fit.cost = fit.total - (fit.camera > 0 ? agreement * agreement / fit.camera : 0);
  if (agreement <= 0) fit.cost = fit.total;
  fit.bias_radps = (s.gyroscope_dt - fit.scale * (fit.rotation * s.camera_dt)) / s.dt;
  return fit;
}

bool holds_enough(const Fit& fit, std::size_t all) {
  return fit.total > 0 && fit.weights >= 0.5 * static_cast<double>(all);
}

/// What a fit leaves unexplained of the turns that it was compared with, 0 to 1. For the search over all
/// offsets: far offsets compare other parts of the motion, and a part without motion fits anything.
double unexplained(const Fit& fit, std::size_t all) {
  return holds_enough(fit, all) ? fit.cost / fit.total : 1;
}

/// Squared residual per interval, rad^2. For near offsets: dividing by the motion would favour those that
/// happen to take in more of it.
double mean_cost(const Fit& fit, std::size_t all) {
  return holds_enough(fit, all) ? fit.cost / fit.weights : std::numeric_limits<double>::infinity();
}

struct OffsetSearch {
  double offset_s = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/// Offsets at steps around a centre; cost: unexplained() or mean_cost().
OffsetSearch search(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, bool mirrored,
                    double centre_s, double radius_s, double step_s, double (*cost)(const Fit&, std::size_t),
                    const RateLimits& limits = {}) {
  OffsetSearch best{centre_s};
  const int steps = static_cast<int>(std::lround(radius_s / step_s));
  for (int i = -steps; i <= steps; ++i) {
    const double offset_s = centre_s + i * step_s;
    const double here =
        cost(fit_at(sums_at(intervals, gyroscope, offset_s, limits), mirrored), intervals.size());
    if (here < best.cost) best = {offset_s, here};
  }
  return best;
}

/// Minimum of the parabola through three costs.
double parabola(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope, bool mirrored,
                double centre_s, double step_s) {
  const auto cost = [&](double offset_s) {
    return fit_at(sums_at(intervals, gyroscope, offset_s), mirrored).cost;
  };
  const double left = cost(centre_s - step_s), middle = cost(centre_s), right = cost(centre_s + step_s);
  const double second = (left - 2 * middle + right) / (step_s * step_s);
  if (second <= 0) return centre_s;
  return centre_s + std::clamp((left - right) / (2 * step_s * second), -step_s, step_s);
}

/// Takes the weight of turns that are grossly wrong, and of those that such a one would reach at another of
/// the offsets that are tried next: a fit would shift the clock to share it between two turns.
void drop_gross(std::vector<Interval>& intervals, const std::vector<double>& residuals, double limit_rad) {
  constexpr double kReach_s = 0.04;
  constexpr double kMaxShare = 0.1;  // more are no faults of single turns
  const auto is_gross = [&](double residual) { return residual > kGross * limit_rad; };
  const auto count = static_cast<double>(std::ranges::count_if(residuals, is_gross));
  if (count > kMaxShare * static_cast<double>(residuals.size())) return;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (!is_gross(residuals[i])) continue;
    const double begin_s = intervals[i].begin_s - kReach_s, end_s = intervals[i].end_s + kReach_s;
    for (Interval& interval : intervals) {
      if (interval.end_s > begin_s && interval.begin_s < end_s) interval.weight = 0;
    }
  }
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
  drop_gross(intervals, residuals, limit);
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

/// Three times the rates that a twentieth exceeds, of either side. Only for the search over all offsets: what
/// follows weighs each turn by its residual.
RateLimits rate_limits(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope) {
  constexpr double kShare = 0.95;
  constexpr double kFactor = 3;
  std::vector<double> gyroscope_radps, camera_radps;
  for (const Interval& interval : intervals) {
    const double dt_s = interval.end_s - interval.begin_s;
    camera_radps.push_back(interval.camera_rad.norm() / dt_s);
    gyroscope_radps.push_back(gyroscope.turn_rad(interval.begin_s, interval.end_s)->norm() / dt_s);
  }
  return {kFactor * quantile(std::move(gyroscope_radps), kShare),
          kFactor * quantile(std::move(camera_radps), kShare)};
}

double camera_rms(const std::vector<Interval>& intervals) {
  double sum = 0;
  for (const Interval& interval : intervals)
    sum += interval.camera_rad.squaredNorm() / std::pow(interval.end_s - interval.begin_s, 2);
  return intervals.empty() ? 0 : std::sqrt(sum / static_cast<double>(intervals.size()));
}

using Matrix8d = Eigen::Matrix<double, 8, 8>;

/// Joint uncertainty of all fitted parameters: offset, rotation (3), bias (3), scale. The curvature of the
/// cost cannot be used, since the noise of the gyroscope contributes to it. So the model is linearised, with
/// the change of the rate from the gyroscope smoothed over kSmoothing_s; the noise that is left in it would
/// count as information about the offset and is taken off. A parameter that the data do not determine has the
/// width of its search interval as uncertainty.
Matrix8d covariance(const std::vector<Interval>& intervals, const GyroscopeIntegral& gyroscope,
                    const Fit& fit, double offset_s, double variance_rad2) {
  constexpr double kSmoothing_s = 0.15;
  Eigen::Matrix<double, 8, 1> prior_sigma;
  prior_sigma << kMaxOffset_s / 2, Vector3d::Constant(radians(90)), Vector3d::Constant(0.1), 1;
  const auto smooth_turn = [&](double time_s) {
    return gyroscope.turn_rad(time_s - kSmoothing_s / 2, time_s + kSmoothing_s / 2);
  };
  Matrix8d information = (variance_rad2 * prior_sigma.cwiseAbs2().cwiseInverse()).asDiagonal();
  double noise = 0;
  for (const Interval& interval : intervals) {
    const auto before = smooth_turn(interval.begin_s + offset_s);
    const auto after = smooth_turn(interval.end_s + offset_s);
    if (!before || !after) continue;
    const double dt_s = interval.end_s - interval.begin_s;
    const Vector3d turned_rad = fit.rotation * interval.camera_rad;
    Eigen::Matrix<double, 3, 8> model;
    model << (*after - *before) / kSmoothing_s, -hat(fit.scale * turned_rad), dt_s * Matrix3d::Identity(),
        turned_rad;
    information += interval.weight * model.transpose() * model;
    noise += interval.weight * 3 * 2 * variance_rad2 / (dt_s * kSmoothing_s);
  }
  // Of the offset's own information, what is left when the others take their part.
  const Eigen::Matrix<double, 7, 1> shared = information.bottomLeftCorner<7, 1>();
  const double taken = shared.dot(information.bottomRightCorner<7, 7>().ldlt().solve(shared));
  const double least = variance_rad2 / (prior_sigma[0] * prior_sigma[0]);
  information(0, 0) = taken + std::max(least, information(0, 0) - taken - noise);
  return variance_rad2 * information.inverse();
}

}  // namespace

double TurnAlignment::cost_of(const Matrix3d& other_rotation_imu_camera) const {
  const double agreement = std::max(0.0, other_rotation_imu_camera.cwiseProduct(cross_rad2).sum());
  return camera_rad2 > 0 ? imu_rad2 - agreement * agreement / camera_rad2 : imu_rad2;
}

std::optional<TurnAlignment> align_turns(const CameraTurns& turns, const GyroscopeIntegral& gyroscope) {
  std::vector<Interval> intervals = intervals_of(turns, gyroscope);
  TurnAlignment result;
  result.camera_rms_radps = camera_rms(intervals);
  if (intervals.size() < kMinIntervals || result.camera_rms_radps < kMinRate_radps) return std::nullopt;
  const RateLimits limits = rate_limits(intervals, gyroscope);
  const OffsetSearch proper =
      search(intervals, gyroscope, false, 0, kMaxOffset_s, kOffsetStep_s, unexplained, limits);
  const OffsetSearch mirror =
      search(intervals, gyroscope, true, 0, kMaxOffset_s, kOffsetStep_s, unexplained, limits);
  const bool mirrored = mirror.cost < kMirroredGain * proper.cost;
  double offset_s = (mirrored ? mirror : proper).offset_s;
  for (int round = 0; round < 3; ++round) {
    const Sums sums = sums_at(intervals, gyroscope, offset_s, round == 0 ? limits : RateLimits{});
    reweight(intervals, gyroscope, fit_at(sums, mirrored), offset_s);
    offset_s = search(intervals, gyroscope, mirrored, offset_s, 0.03, 0.002, mean_cost).offset_s;
    offset_s = parabola(intervals, gyroscope, mirrored, offset_s, 0.004);
  }
  const double vertex_s = parabola(intervals, gyroscope, mirrored, offset_s, 0.004);
  const Fit fit = fit_at(sums_at(intervals, gyroscope, vertex_s), mirrored);
  const double freedom = std::max(1.0, 3 * fit.weights - 8);
  const double variance_rad2 = fit.cost / freedom;
  double dt_s = 0;
  for (const Interval& interval : intervals)
    dt_s += (interval.end_s - interval.begin_s) / static_cast<double>(intervals.size());
  result.intervals = intervals.size();
  // At an end, the cost may fall further beyond it; the refinement must stay within the interval.
  const double farthest_s = std::max(std::abs((mirrored ? mirror : proper).offset_s), std::abs(vertex_s));
  result.offset_found = farthest_s < kMaxOffset_s - kOffsetStep_s;
  result.time_offset_s = vertex_s;
  const Matrix8d known = covariance(intervals, gyroscope, fit, vertex_s, variance_rad2);
  result.time_offset_sigma_s = std::sqrt(known(0, 0));
  result.rotation_imu_camera = fit.rotation;
  result.rotation_sigma_rad =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(known.block<3, 3>(1, 1)).eigenvalues()[2]);
  result.scale = fit.scale;
  result.bias_radps = fit.bias_radps;
  result.residual_radps = std::sqrt(std::max(0.0, fit.cost) / std::max(1.0, fit.weights)) / dt_s;
  result.explained = fit.total > 0 ? 1 - fit.cost / fit.total : 0;
  result.cross_rad2 = fit.cross;
  result.imu_rad2 = fit.total;
  result.camera_rad2 = fit.camera;
  result.freedom = freedom;
  return result;
}

}  // namespace fusebench::inspection::measures
