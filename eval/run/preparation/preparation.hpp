// What a recording says of its own sensors, before anything is run over it.
//
// Parts of the recording, up to 600 frames in all, are tracked at a low resolution, and the timing of the
// image sensors that its calibration leaves open is measured from them (sensor_timing.hpp). Every variant and
// every other system then runs with these values.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::preparation {

enum class Verdict {
  held,      ///< the calibration says it exactly
  measured,  ///< the measurement
  agrees,    ///< the measurement does not contradict what somebody else has published: that is kept
  open,      ///< the recording does not tell it: the calibration's value is kept
};
[[nodiscard]] std::string_view to_string(Verdict verdict);

/// A constant of the sensors, in seconds, with standard deviations.
struct PreparedConstant {
  std::string_view name;  ///< "color_readout", "depth_readout", "depth_delay"
  double before_s = 0;
  double before_sigma_s = 0;
  double measured_s = 0;
  double measured_sigma_s = 0;  ///< 0: it was not measured
  double after_s = 0;
  double after_sigma_s = 0;
  Verdict verdict = Verdict::held;
};

struct Preparation {
  std::size_t frames = 0;   ///< that were checked
  std::size_t tracked = 0;  ///< of these, with a velocity
  std::size_t pairs = 0;    ///< of frames that the timing was measured by
  std::array<PreparedConstant, 3> constants;
};

/// Whether it has frames enough to tell anything of its sensors.
[[nodiscard]] bool is_long_enough(const recording::Recording& recording);

/// Whether its calibration leaves anything open, and it is long enough to tell.
[[nodiscard]] bool can_be_prepared(const recording::Recording& recording);

/// Nothing changes with the number of threads. Errors: those of reading a frame, run_failed (stopped).
[[nodiscard]] Result<Preparation> prepare(const recording::Recording& recording, const Workers& workers,
                                          const std::atomic<bool>* stop);

/// The timing after it.
[[nodiscard]] SensorTiming timing_after(const Preparation& preparation);

/// How notes of what was measured begin.
inline constexpr std::string_view kPreparedNote = "prepared: ";

/// The recording with another timing of its sensors, and notes of what has changed.
[[nodiscard]] recording::Recording with_timing(recording::Recording recording, const SensorTiming& timing);

/// The calibration of the recording's files with that timing.
[[nodiscard]] calibration::RigCalibration rig_with_timing(const recording::Recording& recording,
                                                          const SensorTiming& timing);

}  // namespace fusebench::preparation
