// Registration of two views of the model.
#pragma once

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"
#include "core/baselines/elasticfusion/tracking/camera_tracker.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

/// T_model_live: pose of the live view in the frame of the model view. Both views are rendered from the same
/// pose.
[[nodiscard]] tracking::TrackedMotion register_view(const surfels::SurfelView& live,
                                                    const surfels::SurfelView& model,
                                                    const config::ElasticfusionConfig& config,
                                                    const Workers& workers);

}  // namespace fusebench::baselines::elasticfusion::deformation
