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
#include "datasets/simulator/render/visible_triangles.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::render {

struct LitScene;
class Renderer;

/// A moving foreground object at one instant.
struct Foreground {
  const Renderer& thing;
  SE3 T_object_camera;
};

/// One sample of the pixels of a row.
struct RowSample {
  int row = 0;
  SE3 T_world_camera;
  Vector2d offset_px = Vector2d::Zero();  ///< rays go through (u, row) + offset
  /// Side of the square that the sample stands for; less than 1 where samples of a pixel are averaged.
  float footprint_px = 1;
  float weight = 1;
  double time_s = 0;  ///< of screens that change what they show
  /// Seen from nearby poses by the same camera; spares most of the search for triangles. May be null.
  const VisibleTriangles* nearby = nullptr;
  const Foreground* foreground = nullptr;  ///< hides what is behind it; may be null
};

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

  /// Adds weight times the light (as above) of each sample to `light`, which has the camera's width; the
  /// fourth component means nothing. All samples are of one row, and have the same thing in the foreground or
  /// none.
  void add_light_of_row(const rays::RayField& rays, std::span<const RowSample> samples,
                        std::span<Eigen::Array4f> light) const;

  [[nodiscard]] VisibleTriangles visible_triangles(const rays::RayField& rays, RowPoses poses,
                                                   const Workers& workers) const;

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

  [[nodiscard]] const LitScene& scene() const { return *scene_; }

 private:
  std::unique_ptr<LitScene> scene_;
};

}  // namespace fusebench::simulator::render
