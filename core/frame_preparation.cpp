#include "core/frame_preparation.hpp"

#include <utility>

#include "core/depth_gates.hpp"

namespace fusebench {

bool FramePreparation::compensates(const RgbdFrame& frame) const {
  return config_.terms.motion_compensation && needs_compensation(frame, rig_.timing);
}

void FramePreparation::prepare(const RgbdFrame& frame, const FilterState& motion) {
  if (compensates(frame)) {
    velocity_ = camera_velocity(motion, rig_.T_imu_camera);
    compensate_motion(frame, rig_.camera, rig_.timing, velocity_, workers_, frame_);
  } else {
    frame_ = frame;
  }
  build_pyramid(frame_.grey, config_.patches.levels, pyramid_);
  gate_depth(frame_.depth_m, config_.depth, ungated_depth_m_);
  std::swap(frame_.depth_m, ungated_depth_m_);
}

void FramePreparation::prepare_color(const RgbdFrame& frame) {
  if (!compensates(frame)) return;
  compensate_color(frame, rig_.camera, rig_.timing, velocity_, ungated_depth_m_, workers_, frame_.color);
}

}  // namespace fusebench
