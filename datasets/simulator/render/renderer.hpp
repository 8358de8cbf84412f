// Renders a scene by ray casting: depth and radiance of pixels.
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

/// A moving foreground object at an instant.
struct Foreground {
  const Renderer& thing;
  SE3 T_object_camera;
};

/// One sample for the pixels of a row.
struct RowSample {
  int row = 0;
  SE3 T_world_camera;
  Vector2d offset_px = Vector2d::Zero();  ///< rays go through (u, row) + offset
  /// Side of the square that the sample covers; less than 1 if several samples of a pixel are averaged.
  float footprint_px = 1;
  float weight = 1;
  double time_s = 0;  ///< for screens with changing content
  /// Hits of the same camera at a nearby pose, which avoid most triangle searches. May be null.
  const VisibleTriangles* nearby = nullptr;
  const Foreground* foreground = nullptr;  ///< occludes what is behind it; may be null
};

/// Ray caster of a scene. Rays are independent, so results do not depend on the number of threads.
class Renderer {
 public:
  explicit Renderer(const scene::SimulatedScene& scene);  ///< copies the required data
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders linear light (0 to 1 per channel), one sample per pixel at (u + offset.x, v + offset.y). Pixels
  /// without a hit are black.
  void render_light(const PinholeCamera& camera, const RowPoses& poses, const Vector2d& offset_px,
                    const Workers& workers, Image<Eigen::Vector3f>& light) const;

  /// Adds weight * light of each sample to `light`, which has the width of the camera; the fourth component
  /// is unused. All samples are of one row, with the same foreground object or none.
  void add_light_of_row(const rays::RayField& rays, std::span<const RowSample> samples,
                        std::span<Eigen::Array4f> light) const;

  [[nodiscard]] VisibleTriangles visible_triangles(const rays::RayField& rays, RowPoses poses,
                                                   const Workers& workers) const;

  /// Surface at a ray, for depth sensors.
  struct Surface {
    float depth_m = 0;           ///< z-depth; 0: no hit
    float cos_incidence = 0;     ///< cosine of the angle between ray and surface normal, 0 to 1
    std::uint32_t triangle = 0;  ///< index in the scene
    float reflectance = 1;       ///< as gloss only with material: mean over the colours, 0 to 1
    float gloss = 0;             ///< 0 (matt) to 1 (polished)
  };
  void render_surfaces(const PinholeCamera& camera, const RowPoses& poses, const Workers& workers,
                       Image<Surface>& surfaces, bool material = false) const;

  [[nodiscard]] const LitScene& scene() const { return *scene_; }

 private:
  std::unique_ptr<LitScene> scene_;
};

}  // namespace fusebench::simulator::render
