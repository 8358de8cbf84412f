// Ray casting against triangles. Only the .cpp file includes Embree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "core/base/types.hpp"

namespace fusebench::simulator::rays {

/// The nearest triangle on a ray.
struct RayHit {
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  float distance = 0;  ///< in lengths of the direction
  float u = 0;         ///< barycentric: point = (1 - u - v) a + u b + v c
  float v = 0;
  float cos_incidence = 0;  ///< of the angle between ray and surface normal, 0 to 1 (either side)
  std::uint32_t triangle = kNothing;
};

/// Triangles are solid from both sides. Copies what it needs of the mesh; calls may run at once.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Rays from one origin along directions (any length); one hit each. The three spans and hits have the same
  /// length.
  void cast(const Eigen::Vector3f& origin, std::span<const float> x, std::span<const float> y,
            std::span<const float> z, std::span<RayHit> hits) const;

  /// Rays with an origin each. The spans have the same length.
  struct Rays {
    std::array<std::span<const float>, 3> origin;
    std::array<std::span<const float>, 3> direction;
  };
  /// The nearest triangle of each ray, RayHit::kNothing where there is none. Fast where eight rays that
  /// follow each other are close together.
  void nearest_triangles(const Rays& rays, std::span<std::uint32_t> triangles) const;

  /// Whether anything lies between origin and origin + direction.
  [[nodiscard]] bool blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::simulator::rays
