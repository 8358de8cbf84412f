#include "core/start_in_motion.hpp"

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

}  // namespace

Result<FrameReport> StartInMotion::process(const RgbdFrame& frame, RestartableEstimator& estimator) {
  const bool first = !estimator.estimate();
  Result<FrameReport> report = estimator.process_frame(frame);
  if (first) {
    first_frame_ = frame;
    return report;
  }
  if (first_frame_ && report && report->status != FrameStatus::lost)
    report = process_again(*first_frame_, frame, report->stages, estimator);
  first_frame_.reset();
  return report;
}

}  // namespace fusebench
