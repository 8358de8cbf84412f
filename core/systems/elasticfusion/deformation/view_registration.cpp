#include "core/systems/elasticfusion/deformation/view_registration.hpp"

namespace fusebench::systems::elasticfusion::deformation {

tracking::TrackedMotion register_view(const surfels::SurfelView& live, const surfels::SurfelView& model,
                                      const config::ElasticfusionConfig& config, const Workers& workers) {
  const surfels::LiveFrame as_frame{live.point.z, live.point.z, live.normal, live.color,
                                    surfels::intensity_of(live.color, config.defects)};
  return tracking::CameraTracker(config, workers)
      .track(tracking::live_pyramid(as_frame, live.camera, workers),
             tracking::view_pyramid(model, config.defects), SE3{});
}

}  // namespace fusebench::systems::elasticfusion::deformation
