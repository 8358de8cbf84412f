// Frames whose images are not asked, and what becomes of the state.
#pragma once

#include <cstdint>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/health/frame_report.hpp"
#include "core/tracking_state.hpp"

namespace fusebench::core {

/// Both images are those of the frame before, which was tracked, and so is the pose: nothing changes. With an
/// IMU the pose of the frame's own instant is predicted instead.
void repeat_last(const Tracking& tracking, const SensorRig& rig, health::FrameReport& report);

/// Colour is that of the frame before, so depth is of some instant since, and the images do not say which:
/// measured by it alone, the pose would be one of another instant. Without an IMU the velocity carries the
/// state to the frame, once: a colour camera that stalls must not end the tracking by depth.
[[nodiscard]] bool is_carried_on(const Tracking& tracking, const Novelty& novelty,
                                 const config::TermsConfig& terms);
void carry_on(Tracking& tracking, const filter::GaussianState& predicted, std::int64_t now_ns,
              const SensorRig& rig, health::FrameReport& report);

/// The prediction is not finite: the frame is lost, and the velocity before carries the state to it.
void keep_moving(Tracking& tracking, std::int64_t now_ns, const SensorRig& rig,
                 const config::HealthConfig& health_options, const config::MotionConfig& motion,
                 health::FrameReport& report);

}  // namespace fusebench::core
