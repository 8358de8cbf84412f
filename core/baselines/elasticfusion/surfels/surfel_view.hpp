// Rendered view of surfels: the nearest disc at each pixel.
#pragma once

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/surfels/live_frame.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"
#include "core/baselines/elasticfusion/surfels/visible_surfels.hpp"
#include "core/baselines/point_map.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

inline constexpr std::int32_t kNoSurfel = -1;

struct SurfelView {
  PinholeCamera camera;
  SE3 T_world_camera;
  PointMap point;   ///< intersection of ray and disc, camera frame; z = 0 if there is none
  PointMap normal;  ///< of the disc, camera frame
  ColorImage color;
  Image<std::int32_t> surfel;  ///< index in the map; kNoSurfel also for pixels filled with live data
  std::size_t seen = 0;        ///< Renders views and reuses its buffers.

  [[nodiscard]] double share() const {
    return static_cast<double>(seen) / static_cast<double>(surfel.data.size());
  }
};

/// Renders views, and keeps the memory for it.
class ViewRenderer {
 public:
  /// Skips discs that face away from the camera. The result does not depend on the number of threads.
  void render(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
              const SurfelChoice& choice, const Workers& workers, SurfelView& view);

 private:
  VisibleSurfels visible_;
  Image<float> nearest_m_;
  Image<std::int32_t> drawn_;  ///< index in the visible surfels
};

/// Fills pixels without a surfel with the measurements from the same pose.
void fill_in(const LiveFrame& live, SurfelView& view);

}  // namespace fusebench::baselines::elasticfusion::surfels
