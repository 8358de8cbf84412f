#include "core/steps/tracking_state.hpp"

#include <utility>

#include "core/config/config.hpp"

namespace fusebench::core {

Tracking::Tracking(const config::Config& config, const SensorRig& rig, Beginning begins_with)
    : beginning(std::move(begins_with)),
      model(config.tsdf),
      relocalisation(config, rig),
      loops(config, rig),
      revisits(config.depth, config.loops, rig.camera),
      motion_scale(prediction::initial_motion_scale(config.motion)) {}

}  // namespace fusebench::core
