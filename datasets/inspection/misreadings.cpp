#include "datasets/inspection/misreadings.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "datasets/inspection/checks.hpp"

namespace fusebench::inspection {

namespace {

// Residuals below these are not significant: 1 mm at 1 m, half a grey level.
constexpr double kDepthFloor = 0.001;
constexpr double kIntensityFloor_grey = 0.5;
constexpr double kLostRatio = 4;  // of a pair that a reading warps out of view

const Eigen::DiagonalMatrix<double, 3> kFlip(1, -1, 1);

SE3 reflected(const SE3& pose) {
  const Matrix3d rotation = kFlip * pose.rotation_matrix() * kFlip;
  return {Quaterniond(rotation).normalized(), kFlip * pose.translation};
}

SE3 inverted(const SE3& pose) { return pose.inverse(); }

SE3 rotation_inverted(const SE3& pose) { return {pose.rotation.conjugate(), pose.translation}; }

/// The file has w x y z, and x y z w was read.
SE3 scalar_first(const SE3& pose) {
  const Quaterniond& q = pose.rotation;
  return {Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

using ReadingOf = std::function<measures::Reading(double)>;

/// The best of a row of values, then a golden-section search between its neighbours.
FittedParameter fit(const WarpTest& test, const measures::Reading& base, const std::vector<double>& values,
                    const ReadingOf& reading_of) {
  const auto residuals = test.residuals(base);
  const auto factor = [&](double value) { return test.compare(residuals, reading_of(value)).factor; };
  std::size_t best = 0;
  double best_factor = factor(values[0]);
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double f = factor(values[i]);
    if (f < best_factor) {
      best = i;
      best_factor = f;
    }
  }
  double low = values[best == 0 ? 0 : best - 1], high = values[std::min(best + 1, values.size() - 1)];
  constexpr double kGolden = 0.6180339887498949;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double left_factor = factor(left), right_factor = factor(right);
  for (int i = 0; i < 8; ++i) {
    if (left_factor < right_factor) {
      high = right;
      right = left;
      right_factor = left_factor;
      left = high - kGolden * (high - low);
      left_factor = factor(left);
    } else {
      low = left;
      left = right;
      left_factor = right_factor;
      right = low + kGolden * (high - low);
      right_factor = factor(right);
    }
  }
  const double value = std::min(left_factor, right_factor) < best_factor
                           ? (left_factor < right_factor ? left : right)
                           : values[best];
  return {value, test.compare(residuals, reading_of(value))};
}

std::vector<double> geometric_row(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low * std::pow(high / low, i / (count - 1.0)));
  return values;
}

}  // namespace

WarpTest::WarpTest(const recording::Recording& recording, std::vector<measures::WarpPair> pairs,
                   const Workers& workers)
    : recording_(recording), pairs_(std::move(pairs)), gap_ns_(truth_gap_ns(recording)), workers_(workers) {}

std::vector<std::optional<measures::WarpResidual>> WarpTest::residuals(
    const measures::Reading& reading) const {
  return workers_.map_chunks<std::optional<measures::WarpResidual>>(
      pairs_.size(), 1, [&](std::size_t i, std::size_t) {
        return measures::warp(pairs_[i], recording_.rig.camera, recording_.ground_truth, gap_ns_, reading);
      });
}

Comparison WarpTest::compare(const std::vector<std::optional<measures::WarpResidual>>& base,
                             const measures::Reading& reading) const {
  const auto other = residuals(reading);
  double sum = 0, wins = 0, count = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (!base[i] || !other[i]) continue;  // no ground truth: counts for neither reading
    ++count;
    // A reading must not improve by warping most points out of view.
    const bool lost = other[i]->overlap < 0.5 * base[i]->overlap || other[i]->points < 50;
    const double ratio =
        lost ? std::log(kLostRatio)
             : 0.5 * std::log((other[i]->depth_share + kDepthFloor) / (base[i]->depth_share + kDepthFloor)) +
                   0.5 * std::log((other[i]->intensity_grey + kIntensityFloor_grey) /
                                  (base[i]->intensity_grey + kIntensityFloor_grey));
    sum += ratio;
    if (ratio < 0) ++wins;
  }
  if (count < 0.5 * static_cast<double>(pairs_.size()) || count == 0) return {kLostRatio, 0};
  return {std::exp(sum / count), wins / count};
}

const std::vector<Misreading>& pose_misreadings() {
  static const std::vector<Misreading> kAll = {
      {"truth-not-reflected", "poses reflected about the x-z plane (or fy negated)", &reflected},
      {"truth-inverted", "inverted poses", &inverted},
      {"truth-rotation-inverted", "inverted rotations", &rotation_inverted},
      {"truth-quaternion-order", "quaternions as w x y z", &scalar_first},
  };
  return kAll;
}

FittedParameter fit_depth_scale(const WarpTest& test, const measures::Reading& base) {
  return fit(test, base, geometric_row(0.125, 8, 37), [&](double value) {
    measures::Reading reading = base;
    reading.depth_scale *= value;
    return reading;
  });
}

FittedParameter fit_focal_scale(const WarpTest& test, const measures::Reading& base) {
  return fit(test, base, geometric_row(0.7, 1.0 / 0.7, 17), [&](double value) {
    measures::Reading reading = base;
    reading.focal_scale *= value;
    return reading;
  });
}

FittedParameter fit_truth_shift(const WarpTest& test, const measures::Reading& base) {
  std::vector<double> shifts_s;
  for (int i = -12; i <= 12; ++i) shifts_s.push_back(0.02 * i);
  return fit(test, base, shifts_s, [&](double value) {
    measures::Reading reading = base;
    reading.truth_shift_ns += std::llround(1e9 * value);
    return reading;
  });
}

}  // namespace fusebench::inspection
