#include "core/tracking_state.hpp"

#include "core/config/config.hpp"

namespace fusebench::core {

Tracking::Tracking(const config::Config& config, const SensorRig& rig)
    : model(config.tsdf),
      relocalisation(config, rig),
      loops(config, rig),
      revisits(config.depth, config.loops, rig.camera),
      motion_scale(prediction::initial_motion_scale(config.motion)) {}

}  // namespace fusebench::core
