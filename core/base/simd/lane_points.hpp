// Geometry of eight points for the kernels.
#pragma once

#include <Eigen/Core>

#include "core/base/simd/lanes.hpp"

namespace fusebench::simd {

/// Eight points or directions.
struct Points {
  Float8 x{};
  Float8 y{};
  Float8 z{};
};

[[nodiscard]] inline Points operator+(const Points& a, const Points& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Points operator-(const Points& a, const Points& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Float8 dot(const Points& a, const Points& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
[[nodiscard]] inline Points cross(const Points& a, const Points& b) {
  return {multiply_add(a.y, b.z, -(a.z * b.y)), multiply_add(a.z, b.x, -(a.x * b.z)),
          multiply_add(a.x, b.y, -(a.y * b.x))};
}
[[nodiscard]] inline Float8 norm(const Points& a) { return sqrt(dot(a, a)); }

[[nodiscard]] inline Points rotated(const Eigen::Matrix3f& R, const Points& p) {
  const auto row = [&](int i) {
    return multiply_add(R(i, 2), p.z, multiply_add(R(i, 1), p.y, R(i, 0) * p.x));
  };
  return {row(0), row(1), row(2)};
}
[[nodiscard]] inline Points moved(const Eigen::Matrix3f& R, const Eigen::Vector3f& t, const Points& p) {
  const auto row = [&](int i) {
    return multiply_add(R(i, 2), p.z,
                        multiply_add(R(i, 1), p.y, multiply_add(R(i, 0), p.x, all_lanes(t[i]))));
  };
  return {row(0), row(1), row(2)};
}

}  // namespace fusebench::simd
