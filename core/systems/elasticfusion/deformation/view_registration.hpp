// One view of the model against another.
#pragma once

#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/systems/elasticfusion/surfels/surfel_view.hpp"
#include "core/systems/elasticfusion/tracking/camera_tracker.hpp"

namespace fusebench::systems::elasticfusion::deformation {

/// T_model_live: from where the second view's camera would see what the first one sees. Both start at one
/// place.
[[nodiscard]] tracking::TrackedMotion register_view(const surfels::SurfelView& live,
                                                    const surfels::SurfelView& model,
                                                    const config::ElasticfusionConfig& config,
                                                    const Workers& workers);

}  // namespace fusebench::systems::elasticfusion::deformation
