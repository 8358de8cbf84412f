// Intersection of eight rays with the planes of given triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/simd/lane_points.hpp"
#include "core/base/types.hpp"

namespace fusebench::simulator::render {

/// Eight rays, by lane.
struct RayPacket {
  simd::Points origins;
  simd::Points directions;
  simd::Float8 inverse_length{};  ///< of the directions

  RayPacket(const simd::Points& origins_in, const simd::Points& directions_in)
      : origins(origins_in),
        directions(directions_in),
        inverse_length(simd::all_lanes(1.0F) / simd::norm(directions)) {}

  [[nodiscard]] Eigen::Vector3f origin(std::size_t lane) const {
    return {origins.x[lane], origins.y[lane], origins.z[lane]};
  }
  [[nodiscard]] Eigen::Vector3f direction(std::size_t lane) const {
    return {directions.x[lane], directions.y[lane], directions.z[lane]};
  }
};

/// Hits of eight rays, by lane.
struct PacketHits {
  simd::Int8 triangle = simd::all_lanes(-1);  ///< index in the mesh, -1: nothing
  simd::Float8 distance{};                    ///< in units of the direction's length
  simd::Float8 u{};                           ///< barycentric: point = (1 - u - v) a + u b + v c
  simd::Float8 v{};
  simd::Float8 cos_incidence{};  ///< cosine of the angle between ray and normal (either side), 0 to 1

  /// Copies the lanes of `other` that are set in `taken`.
  void take(simd::Int8 taken, const PacketHits& other) {
    triangle = taken ? other.triangle : triangle;
    distance = taken ? other.distance : distance;
    u = taken ? other.u : u;
    v = taken ? other.v : v;
    cos_incidence = taken ? other.cos_incidence : cos_incidence;
  }
};

/// Calls visit(value, lanes with it) for each distinct value in the lanes whose bit is set.
template <class Visit>
void for_each_value(simd::Int8 values, unsigned lanes, const Visit& visit) {
  std::int32_t by_lane[simd::kLanes];
  std::memcpy(by_lane, &values, sizeof(by_lane));
  while (lanes != 0) {
    const std::int32_t value = by_lane[std::countr_zero(lanes)];
    const simd::Int8 same = values == simd::all_lanes(value);
    visit(value, same);
    lanes &= ~simd::lane_bits(same);
  }
}

/// Planes of the triangles of a mesh, and their faces: sets of triangles with one texture and common
/// vertices.
class TrianglePlanes {
 public:
  /// textures: by triangle, may be empty.
  TrianglePlanes(const Mesh& mesh, const std::vector<std::int32_t>& textures);

  [[nodiscard]] const std::int32_t* faces() const { return faces_.data(); }  ///< by triangle
  [[nodiscard]] const Eigen::Vector3f& normal(std::size_t triangle) const {  ///< unit; 0 without an area
    return planes_[triangle].normal;
  }

  /// Intersections of rays with the plane of the triangle, inside or outside of it.
  [[nodiscard]] PacketHits meet(std::int32_t triangle, const RayPacket& rays) const {
    const Plane& plane = planes_[static_cast<std::size_t>(triangle)];
    const simd::Float8 slope = dot(plane.normal, rays.directions);
    // Relative to a corner, so that origin and plane may be far from the origin of the mesh.
    const simd::Points from_corner{rays.origins.x - plane.corner.x(), rays.origins.y - plane.corner.y(),
                                   rays.origins.z - plane.corner.z()};
    PacketHits hits;
    hits.triangle = simd::all_lanes(triangle);
    hits.distance = -dot(plane.normal, from_corner) / slope;
    hits.u = simd::multiply_add(hits.distance, dot(plane.along_u, rays.directions),
                                dot(plane.along_u, from_corner));
    hits.v = simd::multiply_add(hits.distance, dot(plane.along_v, rays.directions),
                                dot(plane.along_v, from_corner));
    hits.cos_incidence = simd::min(simd::abs(slope) * rays.inverse_length, simd::all_lanes(1.0F));
    return hits;
  }

  /// Lanes whose ray hits the triangle itself, in front of its origin. NaN counts as outside.
  [[nodiscard]] static simd::Int8 inside(const PacketHits& hits) {
    return (hits.distance > 0.0F) & (hits.u >= 0.0F) & (hits.v >= 0.0F) & (hits.u + hits.v <= 1.0F);
  }

 private:
  /// In the mesh's frame: normal . (p - corner) = 0; u = along_u . (p - corner), the same for v.
  struct Plane {
    Eigen::Vector3f corner = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f along_u = Eigen::Vector3f::Zero();
    Eigen::Vector3f along_v = Eigen::Vector3f::Zero();
  };
  static simd::Float8 dot(const Eigen::Vector3f& a, const simd::Points& b) {
    return simd::multiply_add(a.z(), b.z, simd::multiply_add(a.y(), b.y, a.x() * b.x));
  }
  static Plane plane_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);

  std::vector<Plane> planes_;
  std::vector<std::int32_t> faces_;
};

}  // namespace fusebench::simulator::render
