#include "core/estimator/preprocessing/readout.hpp"

#include "core/base/geometry.hpp"

namespace fusebench::preprocessing {

namespace {

/// Each iteration multiplies the error by the local stretch of the image: a few hundredths, for the fastest
/// motion a fifth.
constexpr int kIterationsForth = 6;
/// Each iteration multiplies the error by the motion during the read-out of one row: at most a few
/// hundredths.
constexpr int kIterationsBack = 4;

/// Coefficients of the parabolas through the displacements at inverse depths 0, 1 and 2 / m. Exact for
/// displacements that do not depend on depth.
std::array<simd::Float8, DisplacementParabola::kCount> parabola_through(const Displacement8& at_0,
                                                                        const Displacement8& at_1,
                                                                        const Displacement8& at_2) {
  const auto curvature = [](simd::Float8 f0, simd::Float8 f1, simd::Float8 f2) {
    return 0.5F * ((f2 - f1) - (f1 - f0));
  };
  const simd::Float8 x2 = curvature(at_0.x, at_1.x, at_2.x);
  const simd::Float8 y2 = curvature(at_0.y, at_1.y, at_2.y);
  return {at_0.x, at_1.x - at_0.x - x2, x2, at_0.y, at_1.y - at_0.y - y2, y2};
}

}  // namespace

Readout::Readout(const PinholeCamera& camera, const RowTimes& times, const CameraVelocity& velocity)
    : times_(times),
      turn_radps_(velocity.angular_radps.cast<float>()),
      turn_{simd::all_lanes(turn_radps_.x()), simd::all_lanes(turn_radps_.y()),
            simd::all_lanes(turn_radps_.z())},
      linear_mps_(velocity.linear_mps.cast<float>()),
      fx_(static_cast<float>(camera.fx_px)),
      fy_(static_cast<float>(camera.fy_px)),
      cx_(static_cast<float>(camera.cx_px)),
      cy_(static_cast<float>(camera.cy_px)) {}

std::array<simd::Float8, DisplacementParabola::kCount> Readout::to_rows(simd::Float8 u, float v) const {
  const Eigen::Matrix3f R = turn_until(v, -1.0F);
  return parabola_through(back(u, v, 0.0F, R), back(u, v, 1.0F, R), back(u, v, 2.0F, R));
}

std::array<simd::Float8, Readout::kFromRows> Readout::from_rows(simd::Float8 u, float v) const {
  const Eigen::Matrix3f R = turn_until(v, 1.0F);
  const Carried at_0 = forth(u, v, 0.0F, R);
  const Carried at_1 = forth(u, v, 1.0F, R);
  const Carried at_2 = forth(u, v, 2.0F, R);
  const auto [x0, x1, x2, y0, y1, y2] =
      parabola_through(at_0.displacement, at_1.displacement, at_2.displacement);
  return {x0, x1, x2, y0, y1, y2, at_0.depth_factor, at_1.depth_factor - at_0.depth_factor};
}

/// Fixed-point iteration for the source pixel whose displaced position is (u, v).
Readout::Carried Readout::forth(simd::Float8 u, float v, float inverse_depth,
                                const Eigen::Matrix3f& R) const {
  Carried result;
  for (int i = 0; i < kIterationsForth; ++i) {
    const simd::Points from = ray(u + result.displacement.x, v + result.displacement.y);
    const simd::Float8 later_s = times_.step_s * result.displacement.y;
    const simd::Points carried =
        shifted(rotated_on(simd::rotated(R, from), later_s), (times_.at(v) + later_s) * inverse_depth);
    const Displacement8 there = between(from, carried);
    result = {{-there.x, -there.y}, carried.z};
  }
  return result;
}

/// The read-out time of a point depends on the row of its projection.
Displacement8 Readout::back(simd::Float8 u, float v, float inverse_depth, const Eigen::Matrix3f& R) const {
  const simd::Points now = ray(u, simd::all_lanes(v));
  Displacement8 result;
  for (int i = 0; i < kIterationsBack; ++i) {
    const simd::Float8 later_s = times_.step_s * result.y;
    const simd::Points then = shifted(now, -(times_.at(v) + later_s) * inverse_depth);
    result = between(now, rotated_on(simd::rotated(R, then), -later_s));
  }
  return result;
}

/// Rotation of the camera between the instant of the frame and that of a row, or its inverse.
Eigen::Matrix3f Readout::turn_until(float v, float sign) const {
  const double time_s = static_cast<double>(sign * times_.at(v));
  return so3_exp(time_s * turn_radps_.cast<double>()).toRotationMatrix().cast<float>();
}

/// Rotates a point by the camera rotation in time_s, to second order. The time is the difference between two
/// rows: at 10 rad/s and 100 rows of 54 us the remainder is a hundredth of a pixel.
simd::Points Readout::rotated_on(const simd::Points& a, simd::Float8 time_s) const {
  const simd::Float8 half_squared = 0.5F * time_s * time_s;
  const simd::Points once = simd::cross(turn_, a);
  const simd::Points twice = simd::cross(turn_, once);
  return {simd::multiply_add(half_squared, twice.x, simd::multiply_add(time_s, once.x, a.x)),
          simd::multiply_add(half_squared, twice.y, simd::multiply_add(time_s, once.y, a.y)),
          simd::multiply_add(half_squared, twice.z, simd::multiply_add(time_s, once.z, a.z))};
}

simd::Points Readout::ray(simd::Float8 u, simd::Float8 v) const {
  return {(u - cx_) / fx_, (v - cy_) / fy_, simd::all_lanes(1.0F)};
}

/// Translates a point at unit depth by the camera motion (share = time * inverse depth).
simd::Points Readout::shifted(const simd::Points& point, simd::Float8 share) const {
  return {simd::multiply_add(share, simd::all_lanes(linear_mps_.x()), point.x),
          simd::multiply_add(share, simd::all_lanes(linear_mps_.y()), point.y),
          simd::multiply_add(share, simd::all_lanes(linear_mps_.z()), point.z)};
}

/// Displacement between the pixels of a ray and of the moved point; zero behind the camera. Written as a
/// difference of rays, so zero motion gives exactly zero.
Displacement8 Readout::between(const simd::Points& ray, const simd::Points& carried) const {
  const simd::Int8 in_front = carried.z > 0.0F;
  const simd::Float8 inverse_z = 1.0F / (in_front ? carried.z : simd::all_lanes(1.0F));
  return {in_front ? fx_ * simd::multiply_add(carried.x, inverse_z, -ray.x) : simd::Float8{},
          in_front ? fy_ * simd::multiply_add(carried.y, inverse_z, -ray.y) : simd::Float8{}};
}

}  // namespace fusebench::preprocessing
