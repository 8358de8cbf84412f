// What a camera sees of some surfels: discs, the nearest one behind each pixel.
#pragma once

#include "core/base/parallel.hpp"
#include "core/systems/elasticfusion/surfels/live_frame.hpp"
#include "core/systems/elasticfusion/surfels/surfel_map.hpp"
#include "core/systems/elasticfusion/surfels/visible_surfels.hpp"
#include "core/systems/point_map.hpp"

namespace fusebench::systems::elasticfusion::surfels {

inline constexpr std::int32_t kNoSurfel = -1;

struct SurfelView {
  PinholeCamera camera;
  SE3 T_world_camera;
  PointMap point;   ///< where the ray meets the disc, camera frame; z is 0 where there is none
  PointMap normal;  ///< of the disc, camera frame
  ColorImage color;
  Image<std::int32_t> surfel;  ///< its index in the map; kNoSurfel also where live data fills in
  std::size_t seen = 0;        ///< pixels with a surfel

  [[nodiscard]] double share() const {
    return static_cast<double>(seen) / static_cast<double>(surfel.data.size());
  }
};

/// Renders views, and keeps the memory for it.
class ViewRenderer {
 public:
  /// Discs that look away from the camera are not seen. The same for any number of threads.
  void render(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
              const SurfelChoice& choice, const Workers& workers, SurfelView& view);

 private:
  VisibleSurfels visible_;
  Image<float> nearest_m_;
  Image<std::int32_t> drawn_;  ///< index among the visible ones
};

/// Puts what the camera measured from the same place behind the pixels that see no surfel.
void fill_in(const LiveFrame& live, SurfelView& view);

}  // namespace fusebench::systems::elasticfusion::surfels
