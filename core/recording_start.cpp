#include "core/recording_start.hpp"

#include <fmt/format.h>

namespace fusebench {

namespace {

Result<FrameReport> process_again(const RgbdFrame& first_frame, const RgbdFrame& second_frame,
                                  StageTimes so_far, RestartableEstimator& estimator) {
  const FilterState motion = estimator.estimate()->mean;
  estimator.restart(motion);
  const Result<FrameReport> first = estimator.process_frame(first_frame);
  if (!first) return first;
  Result<FrameReport> second = estimator.process_frame(second_frame);
  if (!second) return second;
  so_far.add(first->stages);
  so_far.add(second->stages);
  second->stages = so_far;
  return second;
}

void wait(FrameReport& report, RestartableEstimator& estimator) {
  report.status = FrameStatus::lost;
  report.reason = fmt::format("waiting for a usable first frame: {}", to_string(report.health));
  report.model_blocks = 0;
  estimator.restart(std::nullopt);
}

}  // namespace

Result<FrameReport> RecordingStart::process(const RgbdFrame& frame, RestartableEstimator& estimator) {
  const bool first = !estimator.estimate();
  Result<FrameReport> report = estimator.process_frame(frame);
  if (first) {
    if (report && report->status == FrameStatus::initialised && report->health != FrameHealth::good)
      wait(*report, estimator);
    first_frame_ = frame;
    return report;
  }
  if (first_frame_ && report && report->status != FrameStatus::lost)
    report = process_again(*first_frame_, frame, report->stages, estimator);
  first_frame_.reset();
  return report;
}

}  // namespace fusebench
