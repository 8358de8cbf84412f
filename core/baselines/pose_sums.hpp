// Normal equations of a pose, summed over pixels, eight at a time.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/simd/lane_points.hpp"
#include "core/base/types.hpp"

namespace fusebench::baselines {

/// Equations for a motion d = (rotation in rad, translation in m) of points in the world (or the frame of a
/// view), p -> p + rotation x p + translation. A motion along `descent` decreases the cost.
struct PoseSums {
  Matrix6d information = Matrix6d::Zero();
  Vector6d descent = Vector6d::Zero();
  double cost = 0;
  double pixels = 0;  ///< number of pixels with a residual

  PoseSums& operator+=(const PoseSums& other);
  /// Divided by the number of pixels.
  [[nodiscard]] PoseSums mean() const;
};

/// Sums of eight pixels; lanes without a residual must be zero.
class PoseSumLanes {
 public:
  /// direction: derivative by d of the residual's target value; first_weight and second_weight: first and
  /// second derivative of the norm.
  void add(const std::array<simd::Float8, 6>& direction, simd::Float8 first_weight,
           simd::Float8 second_weight, simd::Float8 cost, simd::Int8 valid);
  [[nodiscard]] PoseSums total() const;

 private:
  std::array<simd::Float8, 21> information_{};  // upper triangle, row by row
  std::array<simd::Float8, 6> descent_{};
  simd::Float8 cost_{};
  simd::Float8 pixels_{};
};

}  // namespace fusebench::baselines
