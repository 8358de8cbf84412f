#include "core/baselines/elasticfusion/deformation/view_registration.hpp"

#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

tracking::TrackedMotion register_view(const surfels::SurfelView& live, const surfels::SurfelView& model,
                                      const config::ElasticfusionConfig& config, const Workers& workers) {
  return tracking::CameraTracker(config, workers)
      .track(tracking::live_pyramid(live, config.defects, workers),
             tracking::view_pyramid(model, config.defects), SE3{});
}

}  // namespace fusebench::baselines::elasticfusion::deformation
