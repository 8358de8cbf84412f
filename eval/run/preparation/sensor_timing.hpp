// The timing of the image sensors, measured from the images alone: read-out of colour and of depth, delay of
// depth against colour. By pairs of frames between which the velocity of the camera changes
// (timing_pair.hpp).
#pragma once

#include <cstddef>
#include <span>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "eval/run/preparation/moving_frame.hpp"

namespace fusebench::preparation {

/// Read-out of colour, read-out of depth, delay of depth; seconds.
struct TimingEstimate {
  Vector3d value_s = Vector3d::Zero();
  Vector3d sigma_s = Vector3d::Zero();
};
[[nodiscard]] TimingEstimate timing_of(const SensorTiming& timing);
[[nodiscard]] SensorTiming sensor_timing(const TimingEstimate& estimate);

/// The share of a missing change of the timing that a round of an iteration finds, per constant; it is learnt
/// from the steps of rounds that held different timings.
class TimingResponse {
 public:
  /// least: the smallest share that is assumed.
  explicit TimingResponse(double least) : least_(least) {}
  /// A round that held timing_s found that it must change by a step. A constant that changed by at most
  /// least_change_s since the round before keeps its share.
  void take(const Vector3d& timing_s, const Vector3d& step_s, const Vector3d& least_change_s);
  /// step / share: the whole change.
  [[nodiscard]] const Vector3d& share() const { return share_; }

 private:
  double least_;
  bool known_ = false;
  Vector3d timing_s_ = Vector3d::Zero();
  Vector3d step_s_ = Vector3d::Zero();
  Vector3d share_ = Vector3d::Ones();
};

struct MeasuredTiming {
  TimingEstimate posterior;  ///< with the prior
  std::size_t pairs = 0;     ///< of frames; 0: nothing could be measured, and the posterior is the prior
};

/// A value whose prior has no standard deviation is held. Standard deviations are from the scatter of the
/// pairs (sandwich estimator), and of what that does not show: 5 ms, and the time in which the image moves by
/// the 0.15 px that depth may be off colour (focal_length_px: of the recording's images).
[[nodiscard]] MeasuredTiming measure_timing(std::span<const MovingFrames> windows, const SensorTiming& prior,
                                            double focal_length_px, const Workers& workers);

}  // namespace fusebench::preparation
