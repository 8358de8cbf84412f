// Ray casting of a scene: depth and radiance of pixels.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "datasets/simulator/rays/ray_field.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::render {

/// Where the rays of an image start: one pose for each row, so that a rolling shutter is a list of poses.
/// Rows share a pose if the list has one entry.
struct RowPoses {
  std::vector<SE3> T_world_camera;

  [[nodiscard]] const SE3& of_row(int row) const {
    return T_world_camera.size() == 1 ? T_world_camera.front()
                                      : T_world_camera[static_cast<std::size_t>(row)];
  }
};

class Renderer;

/// A moving foreground object at one instant.
struct Foreground {
  const Renderer& thing;
  SE3 T_object_camera;
};

/// How long a screen shows a page.
inline constexpr double kPage_s = 0.8;

/// A ray caster over a scene. Rays are independent, so results do not depend on the number of threads.
class Renderer {
 public:
  explicit Renderer(const scene::SimulatedScene& scene);  ///< keeps its own copy of what it needs
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Linear light (0 to 1 a channel), one sample a pixel, at (u + offset.x, v + offset.y). Pixels that see
  /// nothing are black.
  void render_light(const PinholeCamera& camera, const RowPoses& poses, const Vector2d& offset_px,
                    const Workers& workers, Image<Eigen::Vector3f>& light) const;

  /// Adds the light of one row (as above, times weight) to `light`, which has the camera's width.
  /// footprint_px: the side of the square that the sample stands for; less than 1 where samples of a pixel
  /// are averaged. A foreground hides what is behind it. time_s: of screens that change what they show.
  void add_light_of_row(const rays::RayField& rays, int row, const SE3& T_world_camera,
                        const Vector2d& offset_px, float footprint_px, float weight,
                        std::span<Eigen::Vector3f> light, const Foreground* foreground = nullptr,
                        double time_s = 0) const;

  /// What a ray meets, for depth sensors.
  struct Surface {
    float depth_m = 0;           ///< z-depth, 0: nothing
    float cos_incidence = 0;     ///< of the angle between the ray and the surface's normal, 0 to 1
    std::uint32_t triangle = 0;  ///< index in the scene
    float reflectance = 1;       ///< these two only with material: mean over the colours, 0 to 1
    float gloss = 0;             ///< 0 matt to 1 polished
  };
  void render_surfaces(const PinholeCamera& camera, const RowPoses& poses, const Workers& workers,
                       Image<Surface>& surfaces, bool material = false) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::simulator::render
