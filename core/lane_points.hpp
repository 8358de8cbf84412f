// Eight points at once, and the little geometry that kernels need.
#pragma once

#include <Eigen/Core>

#include "core/lanes.hpp"

namespace fusebench {

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
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Points cross(const Points& a, const Points& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline Float8 norm(const Points& a) { return sqrt(dot(a, a)); }

[[nodiscard]] inline Points rotated(const Eigen::Matrix3f& R, const Points& p) {
  return {R(0, 0) * p.x + R(0, 1) * p.y + R(0, 2) * p.z, R(1, 0) * p.x + R(1, 1) * p.y + R(1, 2) * p.z,
          R(2, 0) * p.x + R(2, 1) * p.y + R(2, 2) * p.z};
}
[[nodiscard]] inline Points moved(const Eigen::Matrix3f& R, const Eigen::Vector3f& t, const Points& p) {
  const Points turned = rotated(R, p);
  return {turned.x + t.x(), turned.y + t.y(), turned.z + t.z()};
}

}  // namespace fusebench
