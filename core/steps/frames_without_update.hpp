// Frames that skip the image update (repeated images, non-finite prediction) and how the state is propagated
// through them.
#pragma once

#include <cstdint>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/health/frame_report.hpp"
#include "core/steps/tracking_state.hpp"

namespace fusebench::core {

/// Both images repeat those of the last tracked frame: keeps its pose. With an IMU, predicts the pose of the
/// instant of the frame instead.
void repeat_last(const Tracking& tracking, const SensorRig& rig, health::FrameReport& report);

/// Handles a repeated colour image with new depth. The instant of the depth is unknown, so a pose measured
/// from it would belong to another instant. Without an IMU the velocity propagates the state to the frame,
/// but only once, so that a stalled colour camera does not end the tracking by depth.
[[nodiscard]] bool is_carried_on(const Tracking& tracking, const Novelty& novelty,
                                 const config::TermsConfig& terms);
void carry_on(Tracking& tracking, const filter::GaussianState& predicted, std::int64_t now_ns,
              const SensorRig& rig, health::FrameReport& report);

/// The prediction is not finite: the frame is lost, and the state is propagated with the last velocity.
void keep_moving(Tracking& tracking, std::int64_t now_ns, const SensorRig& rig,
                 const config::HealthConfig& health_options, const config::MotionConfig& motion,
                 health::FrameReport& report);

}  // namespace fusebench::core
