#include "core/recording_start.hpp"

#include <fmt/format.h>

#include "core/config/groups/prediction_config.hpp"

namespace fusebench::core {

namespace {

Result<health::FrameReport> process_again(const RgbdFrame& first_frame, const RgbdFrame& second_frame,
                                          health::StageTimes so_far, RestartableEstimator& estimator) {
  const filter::FilterState motion = estimator.estimate()->mean;
  estimator.restart(motion);
  const Result<health::FrameReport> first = estimator.process_frame(first_frame);
  if (!first) return first;
  Result<health::FrameReport> second = estimator.process_frame(second_frame);
  if (!second) return second;
  so_far.add(first->stages);
  so_far.add(second->stages);
  second->stages = so_far;
  return second;
}

void wait(health::FrameReport& report, RestartableEstimator& estimator) {
  report.status = health::FrameStatus::lost;
  report.reason = fmt::format("waiting for a usable first frame: {}", health::to_string(report.health));
  report.model_blocks = 0;
  estimator.restart(std::nullopt);
}

}  // namespace

Result<health::FrameReport> RecordingStart::process(const RgbdFrame& frame, RestartableEstimator& estimator) {
  if (!estimator.estimate()) return process_first(frame, estimator);
  Result<health::FrameReport> report = estimator.process_frame(frame);
  if (!report || confirmed_) return report;
  if (is_false_start(*report)) {
    health::StageTimes so_far = report->stages;
    estimator.restart(std::nullopt);
    report = process_first(frame, estimator);
    if (!report) return report;
    so_far.add(report->stages);
    report->stages = so_far;
    if (report->status == health::FrameStatus::initialised)
      report->reason = "started again: hardly a frame could be tracked from the first start";
    return report;
  }
  if (report->status != health::FrameStatus::lost && first_frame_) {
    report = process_again(*first_frame_, frame, report->stages, estimator);
    if (!report) return report;
    if (report->status == health::FrameStatus::lost) ++lost_frames_;
  }
  first_frame_.reset();
  if (report->status != health::FrameStatus::lost)
    confirmed_ = ++tracked_frames_ >= config_.false_start_frames;
  return report;
}

Result<health::FrameReport> RecordingStart::process_first(const RgbdFrame& frame,
                                                          RestartableEstimator& estimator) {
  Result<health::FrameReport> report = estimator.process_frame(frame);
  if (report && report->status == health::FrameStatus::initialised &&
      report->health != health::FrameHealth::good)
    wait(*report, estimator);
  first_frame_ = frame;
  lost_frames_ = tracked_frames_ = 0;
  return report;
}

/// A frame that is lost although its images are sound does not show what the first one showed.
bool RecordingStart::is_false_start(const health::FrameReport& report) {
  if (report.status != health::FrameStatus::lost) return false;
  const bool sound = report.health != health::FrameHealth::dark &&
                     report.health != health::FrameHealth::diverged &&
                     report.health != health::FrameHealth::short_of_depth &&
                     report.health != health::FrameHealth::short_of_texture;
  return ++lost_frames_ >= config_.false_start_frames && sound;
}

}  // namespace fusebench::core
