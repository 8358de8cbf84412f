#include "core/frame_preparation.hpp"

#include <algorithm>
#include <utility>

#include "core/alignment/reference_points.hpp"
#include "core/preprocessing/depth_gates.hpp"

namespace fusebench::core {

bool FramePreparation::compensates(const RgbdFrame& frame) const {
  return config_.terms.motion_compensation && preprocessing::needs_compensation(frame, rig_.timing);
}

bool FramePreparation::is_outdated(const RgbdFrame& frame, const filter::FilterState& predicted,
                                   const filter::FilterState& estimated) const {
  return compensates(frame) &&
         preprocessing::velocity_changed_much(predicted, estimated, config_.compensation);
}

void FramePreparation::prepare(const RgbdFrame& frame, const filter::FilterState& motion,
                               health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::preprocess);
  if (compensates(frame)) {
    velocity_ = preprocessing::camera_velocity(motion, rig_.T_imu_camera);
    preprocessing::compensate_motion(frame, rig_.camera, rig_.timing, velocity_, workers_, frame_);
  } else {
    frame_ = frame;
  }
  build_pyramid(frame_.grey,
                std::max(config_.patches.levels, alignment::alignment_levels(rig_.camera, config_.alignment)),
                pyramid_);
  preprocessing::gate_depth(frame_.depth_m, config_.depth, ungated_depth_m_);
  std::swap(frame_.depth_m, ungated_depth_m_);
}

void FramePreparation::prepare_color(const RgbdFrame& frame, health::StageTimes& stages) {
  if (!compensates(frame)) return;
  const health::StageClock clock(stages, health::Stage::preprocess);
  preprocessing::compensate_color(frame, rig_.camera, rig_.timing, velocity_, ungated_depth_m_, workers_,
                                  frame_.color);
}

}  // namespace fusebench::core
