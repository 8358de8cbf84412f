#include "core/steps/frame_preparation.hpp"

#include <algorithm>
#include <utility>

#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/estimator/alignment/reference_points.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::core {

void FramePreparation::prepare(const RgbdFrame& frame, const filter::FilterState& motion,
                               health::StageTimes& stages) {
  const health::StageClock clock(stages, health::Stage::preprocess);
  source_ = &frame;
  timing_ = preprocessing::estimated_timing(frame, rig_.timing, motion.sensors);
  compensated_ = terms_.motion_compensation && !timing_.is_one_instant();
  if (compensated_) {
    motion_ = motion;
    velocity_ = preprocessing::camera_velocity(motion, rig_.T_imu_camera);
    preprocessing::compensate_motion(frame, rig_.camera, timing_, velocity_, workers_, frame_);
  } else {
    frame_ = frame;
  }
  build_pyramid(frame_.grey, alignment::pyramid_levels(rig_.camera, patches_.levels, alignment_), pyramid_);
  preprocessing::gate_depth(frame_.depth_m, depth_, ungated_depth_m_);
  std::swap(frame_.depth_m, ungated_depth_m_);
}

bool FramePreparation::prepare_again(const filter::FilterState& motion,
                                     const preprocessing::VelocityTolerance& tolerance,
                                     health::StageTimes& stages) {
  if (!compensated_ || !preprocessing::velocity_changed_much(motion_, motion, tolerance)) return false;
  prepare(*source_, motion, stages);
  return true;
}

void FramePreparation::prepare_color(health::StageTimes& stages) {
  if (!compensated_) return;
  const health::StageClock clock(stages, health::Stage::preprocess);
  preprocessing::compensate_color(*source_, rig_.camera, timing_, velocity_, ungated_depth_m_, workers_,
                                  frame_.color);
}

std::span<const GreyImage> FramePreparation::pyramid() const {
  return std::span(pyramid_).first(static_cast<std::size_t>(patches_.levels));
}

const DepthImage& FramePreparation::patch_depth_m() const {
  const bool ungated = patches_.reference_surface == config::ReferenceSurface::frame_ungated;
  return ungated ? ungated_depth_m_ : frame_.depth_m;
}

}  // namespace fusebench::core
