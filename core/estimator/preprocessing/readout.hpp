// Rolling shutter: displacement of pixels between the instant of a frame and the read-out of a row.
#pragma once

#include <array>

#include "core/base/simd/lane_points.hpp"
#include "core/base/types.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"

namespace fusebench::preprocessing {

/// Exposure times of the image rows relative to the instant of the frame.
struct RowTimes {
  RowTimes(int rows, double delay_s, double readout_s)
      : first_s(static_cast<float>(delay_s - 0.5 * readout_s)),
        step_s(static_cast<float>(readout_s / (rows - 1))) {}

  [[nodiscard]] float at(float row) const { return first_s + step_s * row; }

  float first_s;
  float step_s;
};

/// Eight displacements, pixels.
struct Displacement8 {
  simd::Float8 x{};
  simd::Float8 y{};
};

/// Displacement as a parabola in inverse depth: coefficients x0, x1, x2, y0, y1, y2, through inverse depths
/// 0, 1 and 2 / m. For a motion of 20 mm at 0.4 m the remainder is 0.01 px.
struct DisplacementParabola {
  static constexpr std::size_t kCount = 6;

  template <class Coefficient>
  [[nodiscard]] static Displacement8 at(simd::Float8 inverse_depth, const Coefficient& coefficient) {
    const auto parabola = [&](std::size_t i) {
      return simd::multiply_add(inverse_depth,
                                simd::multiply_add(inverse_depth, coefficient(i + 2), coefficient(i + 1)),
                                coefficient(i));
    };
    return {parabola(0), parabola(3)};
  }
};

/// Pixel displacements for a camera with constant velocity around a frame, with a rolling-shutter image.
class Readout {
 public:
  Readout(const PinholeCamera& camera, const RowTimes& times, const CameraVelocity& velocity);

  /// Displacement from pixels of the frame to the image positions of the same points at their row times.
  [[nodiscard]] std::array<simd::Float8, DisplacementParabola::kCount> to_rows(simd::Float8 u, float v) const;

  /// Indices in the result of from_rows(), after the parabolas.
  static constexpr std::size_t kDepthFactor = DisplacementParabola::kCount;
  static constexpr std::size_t kDepthShift_m = kDepthFactor + 1;
  static constexpr std::size_t kFromRows = kDepthShift_m + 1;

  /// Displacement from pixels of the frame to the image pixels that move there, by the inverse depth of the
  /// image pixel; and the factor and summand that convert its depth.
  [[nodiscard]] std::array<simd::Float8, kFromRows> from_rows(simd::Float8 u, float v) const;

 private:
  struct Carried {
    Displacement8 displacement;
    simd::Float8 depth_factor{};
  };
  [[nodiscard]] Carried forth(simd::Float8 u, float v, float inverse_depth, const Eigen::Matrix3f& R) const;
  [[nodiscard]] Displacement8 back(simd::Float8 u, float v, float inverse_depth,
                                   const Eigen::Matrix3f& R) const;
  [[nodiscard]] Eigen::Matrix3f turn_until(float v, float sign) const;
  [[nodiscard]] simd::Points rotated_on(const simd::Points& a, simd::Float8 time_s) const;
  [[nodiscard]] simd::Points ray(simd::Float8 u, simd::Float8 v) const;
  [[nodiscard]] simd::Points shifted(const simd::Points& point, simd::Float8 share) const;
  [[nodiscard]] Displacement8 between(const simd::Points& ray, const simd::Points& carried) const;

  RowTimes times_;
  Eigen::Vector3f turn_radps_;
  simd::Points turn_;  // equal in all lanes
  Eigen::Vector3f linear_mps_;
  float fx_, fy_, cx_, cy_;  // pixels
};

}  // namespace fusebench::preprocessing
