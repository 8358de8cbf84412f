// Camera rays in packets of eight, and lists of rays.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/simd/lane_points.hpp"
#include "datasets/simulator/rays/ray_caster.hpp"
#include "datasets/simulator/rays/ray_field.hpp"
#include "datasets/simulator/render/triangle_planes.hpp"

namespace fusebench::simulator::render {

/// The first `count` of eight lanes.
inline unsigned first_lanes(std::size_t count) { return count >= simd::kLanes ? 0xFF : (1U << count) - 1; }

inline std::size_t whole_packets(std::size_t count) {
  return (count + simd::kLanes - 1) / simd::kLanes * simd::kLanes;
}

/// Directions of a row of pixels on the plane z = 1, padded to whole packets.
struct CameraRow {
  std::vector<float> x;
  std::vector<float> y;

  CameraRow(const rays::RayField& field, int row, const Vector2d& offset_px) {
    const auto width = static_cast<std::size_t>(field.camera().width_px);
    x.resize(whole_packets(width));
    y.resize(x.size());
    field.row(row, offset_px, std::span(x).first(width), std::span(y).first(width));
    std::fill(x.begin() + static_cast<std::ptrdiff_t>(width), x.end(), x[width - 1]);
    std::fill(y.begin() + static_cast<std::ptrdiff_t>(width), y.end(), y[width - 1]);
  }
  [[nodiscard]] simd::Points packet(std::size_t begin) const {
    return {simd::load(&x[begin]), simd::load(&y[begin]), simd::all_lanes(1.0F)};
  }
};

/// Camera pose in single precision.
struct CameraPose {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;

  explicit CameraPose(const SE3& T) : R(T.rotation_matrix().cast<float>()), t(T.translation.cast<float>()) {}

  /// Rays of the camera; distances along them are z-depths.
  [[nodiscard]] RayPacket rays(const simd::Points& directions_camera) const {
    return {{simd::all_lanes(t.x()), simd::all_lanes(t.y()), simd::all_lanes(t.z())},
            simd::rotated(R, directions_camera)};
  }
};

/// A list of rays in whole packets.
class RayList {
 public:
  explicit RayList(std::size_t count) : size_(whole_packets(count)) {
    for (auto& values : values_) values.resize(size_);
  }
  void set(std::size_t begin, const RayPacket& packet) {
    const std::array<simd::Float8, 6> lanes = {packet.origins.x,    packet.origins.y,    packet.origins.z,
                                               packet.directions.x, packet.directions.y, packet.directions.z};
    for (std::size_t k = 0; k < lanes.size(); ++k) simd::store(lanes[k], &values_[k][begin]);
  }
  void set(std::size_t i, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    for (std::size_t k = 0; k < 3; ++k) {
      values_[k][i] = origin[static_cast<Eigen::Index>(k)];
      values_[k + 3][i] = direction[static_cast<Eigen::Index>(k)];
    }
  }
  /// Copies ray i - 1 to i and to the rays after it.
  void repeat_from(std::size_t i) {
    for (auto& values : values_)
      std::fill(values.begin() + static_cast<std::ptrdiff_t>(i), values.end(), values[i - 1]);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] RayPacket packet(std::size_t begin) const {
    const auto at = [&](std::size_t k) { return simd::load(&values_[k][begin]); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
  }
  [[nodiscard]] rays::RayCaster::Rays rays() const {
    return {{values_[0], values_[1], values_[2]}, {values_[3], values_[4], values_[5]}};
  }

 private:
  std::size_t size_;
  std::array<std::vector<float>, 6> values_;  // origin, direction
};

/// Rays through the centres of a row of pixels.
[[nodiscard]] inline RayList rays_of_row(const rays::RayField& field, int row, const SE3& T_world_camera) {
  const CameraRow camera(field, row, Vector2d::Zero());
  const CameraPose pose(T_world_camera);
  RayList list(camera.x.size());
  for (std::size_t begin = 0; begin < list.size(); begin += simd::kLanes)
    list.set(begin, pose.rays(camera.packet(begin)));
  return list;
}

}  // namespace fusebench::simulator::render
