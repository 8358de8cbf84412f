#include "core/estimator/acceptance/recording_start.hpp"

#include <utility>

#include "core/config/groups/prediction_config.hpp"

namespace fusebench::acceptance {

StartAction RecordingStart::judge(const health::FrameReport& report) {
  if (confirmed_) return StartAction::go_on;
  if (report.status == health::FrameStatus::initialised) {
    lost_frames_ = tracked_frames_ = 0;
    is_second_ = report.health == health::FrameHealth::good;
    return is_second_ ? StartAction::go_on : StartAction::wait;
  }
  const bool is_second = std::exchange(is_second_, false);
  if (report.status == health::FrameStatus::lost)
    return is_false_start(report) ? StartAction::start_here : StartAction::go_on;
  if (is_second) return StartAction::start_again;
  confirmed_ = ++tracked_frames_ >= config_.false_start_frames;
  return StartAction::go_on;
}

/// Counts a lost frame with sound images as evidence that the first frame was unsuitable.
bool RecordingStart::is_false_start(const health::FrameReport& report) {
  return ++lost_frames_ >= config_.false_start_frames && health::is_sound(report.health);
}

}  // namespace fusebench::acceptance
