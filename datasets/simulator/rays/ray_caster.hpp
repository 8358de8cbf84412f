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

  float distance = 0;  ///< in units of the direction's length
  float u = 0;         ///< barycentric: point = (1 - u - v) a + u b + v c
  float v = 0;
  float cos_incidence = 0;  ///< cosine of the angle between ray and surface normal, 0 to 1 (either side)
  std::uint32_t triangle = kNothing;
};

/// Triangles are hit from both sides. Copies the required data of the mesh; thread-safe.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Casts rays from one origin along directions of any length; one hit each. The three spans and hits have
  /// the same length.
  void cast(const Eigen::Vector3f& origin, std::span<const float> x, std::span<const float> y,
            std::span<const float> z, std::span<RayHit> hits) const;

  /// Rays with individual origins. The spans have the same length.
  struct Rays {
    std::array<std::span<const float>, 3> origin;
    std::array<std::span<const float>, 3> direction;
  };
  /// Nearest triangle of each ray, RayHit::kNothing if there is none. Fast if groups of eight consecutive
  /// rays are close together.
  void nearest_triangles(const Rays& rays, std::span<std::uint32_t> triangles) const;

  /// True if there is a surface between origin and origin + direction.
  [[nodiscard]] bool blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::simulator::rays
