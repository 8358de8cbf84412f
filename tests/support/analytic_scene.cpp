#include "tests/support/analytic_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fusebench {

namespace {

// Part of a line inside a convex solid: from `enter` to `leave`, and the outer normals there.
struct Chord {
  double enter_m = 0;
  double leave_m = 0;
  Vector3d enter_normal = Vector3d::Zero();
  Vector3d leave_normal = Vector3d::Zero();
};

std::optional<Chord> chord(const AnalyticSphere& sphere, const Vector3d& origin, const Vector3d& direction) {
  const Vector3d offset = origin - sphere.center_world;
  const double middle = -offset.dot(direction);
  const double under_root = middle * middle - offset.squaredNorm() + sphere.radius_m * sphere.radius_m;
  if (under_root <= 0) return std::nullopt;
  const double half = std::sqrt(under_root);
  return Chord{middle - half, middle + half, (offset + (middle - half) * direction).normalized(),
               (offset + (middle + half) * direction).normalized()};
}

std::optional<Chord> chord(const AnalyticBox& box, const Vector3d& origin, const Vector3d& direction) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Chord result{-kInfinity, kInfinity, Vector3d::Zero(), Vector3d::Zero()};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] <= box.min_world[axis] || origin[axis] >= box.max_world[axis]) return std::nullopt;
      continue;
    }
    const bool forward = direction[axis] > 0;
    const double sign = forward ? 1.0 : -1.0;
    const double enter = ((forward ? box.min_world : box.max_world)[axis] - origin[axis]) / direction[axis];
    const double leave = ((forward ? box.max_world : box.min_world)[axis] - origin[axis]) / direction[axis];
    if (enter > result.enter_m) {
      result.enter_m = enter;
      result.enter_normal = -sign * Vector3d::Unit(axis);
    }
    if (leave < result.leave_m) {
      result.leave_m = leave;
      result.leave_normal = sign * Vector3d::Unit(axis);
    }
  }
  if (result.enter_m >= result.leave_m) return std::nullopt;
  return result;
}

std::optional<AnalyticHit> hit(const AnalyticSphere& sphere, const Vector3d& origin,
                               const Vector3d& direction) {
  const auto found = chord(sphere, origin, direction);
  if (!found || found->enter_m <= 0) return std::nullopt;
  return AnalyticHit{found->enter_m, found->enter_normal, sphere.color};
}

std::optional<AnalyticHit> hit(const AnalyticBox& box, const Vector3d& origin, const Vector3d& direction) {
  const auto found = chord(box, origin, direction);
  if (!found) return std::nullopt;
  if (box.inside_out) {
    if (found->leave_m <= 0) return std::nullopt;
    return AnalyticHit{found->leave_m, -found->leave_normal, box.color};
  }
  if (found->enter_m <= 0) return std::nullopt;
  return AnalyticHit{found->enter_m, found->enter_normal, box.color};
}

std::optional<AnalyticHit> hit(const AnalyticPlane& plane, const Vector3d& origin,
                               const Vector3d& direction) {
  const double approach = -plane.normal_world.dot(direction);
  const double height_m = plane.normal_world.dot(origin) - plane.offset_m;
  if (approach <= 0 || height_m <= 0) return std::nullopt;
  return AnalyticHit{height_m / approach, plane.normal_world, plane.color};
}

double signed_distance(const AnalyticSphere& sphere, const Vector3d& point) {
  return (point - sphere.center_world).norm() - sphere.radius_m;
}

double signed_distance(const AnalyticBox& box, const Vector3d& point) {
  const Vector3d outside = (box.min_world - point).cwiseMax(point - box.max_world);
  const double distance = outside.cwiseMax(0.0).norm() + std::min(0.0, outside.maxCoeff());
  return box.inside_out ? -distance : distance;
}

double signed_distance(const AnalyticPlane& plane, const Vector3d& point) {
  return plane.normal_world.dot(point) - plane.offset_m;
}

Vector3d fibonacci_direction(int i, int count) {
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(golden_rad * i), radius * std::sin(golden_rad * i), z};
}

}  // namespace

std::optional<AnalyticHit> AnalyticScene::intersect(const Vector3d& origin_world,
                                                    const Vector3d& direction_world) const {
  std::optional<AnalyticHit> nearest;
  for (const AnalyticShape& shape : shapes) {
    const auto found =
        std::visit([&](const auto& solid) { return hit(solid, origin_world, direction_world); }, shape);
    if (found && (!nearest || found->distance_m < nearest->distance_m)) nearest = found;
  }
  return nearest;
}

double AnalyticScene::distance_m(const Vector3d& point_world) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const AnalyticShape& shape : shapes) {
    nearest = std::min(
        nearest, std::visit([&](const auto& solid) { return signed_distance(solid, point_world); }, shape));
  }
  return nearest;
}

Vector3d AnalyticScene::normal_at(const Vector3d& point_world) const {
  constexpr double kStep_m = 1e-6;
  Vector3d gradient;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector3d step = kStep_m * Vector3d::Unit(axis);
    gradient[axis] = distance_m(point_world + step) - distance_m(point_world - step);
  }
  return gradient.normalized();
}

RgbdFrame AnalyticScene::render(const PinholeCamera& camera, const SE3& T_world_camera,
                                double max_incidence_deg) const {
  const double min_cosine = std::cos(max_incidence_deg * std::numbers::pi / 180.0);
  const Matrix3d axes = T_world_camera.rotation_matrix();
  RgbdFrame frame;
  frame.color = ColorImage(camera.width_px, camera.height_px);
  frame.depth_m = DepthImage(camera.width_px, camera.height_px);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Vector3d ray = camera.back_project(x, y, 1.0);
      const Vector3d direction = (axes * ray).normalized();
      const auto found = intersect(T_world_camera.translation, direction);
      if (!found) continue;
      frame.color(x, y) = found->color;
      if (-direction.dot(found->normal_world) < min_cosine) continue;
      frame.depth_m(x, y) = static_cast<float>(found->distance_m / ray.norm());
    }
  }
  frame.grey = to_grey(frame.color);
  return frame;
}

PinholeCamera test_camera(int width_px, int height_px, double field_of_view_deg) {
  const double focal_px = 0.5 * width_px / std::tan(0.5 * field_of_view_deg * std::numbers::pi / 180.0);
  return {width_px, height_px, focal_px, focal_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1)};
}

SE3 look_at(const Vector3d& eye_world, const Vector3d& target_world) {
  const Vector3d forward = (target_world - eye_world).normalized();
  const Vector3d reference = std::abs(forward.y()) < 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
  Matrix3d axes;
  axes.col(0) = reference.cross(forward).normalized();
  axes.col(1) = forward.cross(axes.col(0));
  axes.col(2) = forward;
  return {Quaterniond(axes).normalized(), eye_world};
}

std::vector<SE3> poses_around(const Vector3d& center_world, double distance_m, int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(look_at(center_world + distance_m * fibonacci_direction(i, count), center_world));
  }
  return poses;
}

std::vector<SE3> poses_looking_out(const Vector3d& eye_world, int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(look_at(eye_world, eye_world + fibonacci_direction(i, count)));
  return poses;
}

}  // namespace fusebench
