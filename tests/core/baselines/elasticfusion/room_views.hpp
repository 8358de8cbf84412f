// Views of the textured room, as a frame and as a view of the model.
#pragma once

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/surfels/live_frame.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench::testing {

inline constexpr auto kFixed = config::PeerDefects::fixed;

inline baselines::elasticfusion::surfels::LiveFrame live_at(const SE3& T_world_camera,
                                                            const Workers& workers) {
  config::DepthConfig depth;
  depth.max_m = 6;
  return baselines::elasticfusion::surfels::make_live_frame(
      TexturedRoom{}.render(small_camera(), T_world_camera, 0), small_camera(), depth, kFixed, workers);
}

/// A model equal to the measurement of the camera.
inline baselines::elasticfusion::surfels::SurfelView view_of(
    const baselines::elasticfusion::surfels::LiveFrame& live) {
  baselines::elasticfusion::surfels::SurfelView view;
  view.camera = small_camera();
  const int width = view.camera.width_px, height = view.camera.height_px;
  view.point.resize(width, height);
  view.normal.resize(width, height);
  view.color = ColorImage(width, height);
  view.surfel = Image<std::int32_t>(width, height, baselines::elasticfusion::surfels::kNoSurfel);
  fill_in(live, view);
  return view;
}

}  // namespace fusebench::testing
