// A batch estimate of a whole recording: a reference where there is no truth.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/smoother/batch_estimate.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/run/run.hpp"

namespace fusebench::batch_estimation {

struct SmoothedRecording {
  std::vector<std::int64_t> stamps_ns;    ///< what outputs call the frames
  std::vector<std::int64_t> instants_ns;  ///< that the states are of
  Trajectory trajectory;                  ///< of the camera; all frames, also those that were lost
  Trajectory measuring_trajectory;        ///< of the run that measured, with the IMU's noise exaggerated
  smoother::BatchEstimate estimate;
  std::size_t tracked = 0;
};

/// The calibration is held fixed, but the clocks' offset is estimated around 0 with the configuration's prior
/// (initialisation.imu_time_offset_sigma_s). Errors: those of measure_motion() and estimate_batch().
[[nodiscard]] Result<SmoothedRecording> smooth(const recording::Recording& recording,
                                               const config::Config& config, const Workers& workers,
                                               const run::RunControl& control);

/// What to beware of: that it did not converge, frames that were lost. Empty if all is well.
[[nodiscard]] std::vector<std::string> smoothing_remarks(const SmoothedRecording& smoothed);

/// trajectory.tum: its first line is kPseudoGroundTruth, by which a reader knows it.
[[nodiscard]] std::string pseudo_truth_text(const SmoothedRecording& smoothed);

/// states.csv: capture instant (ns); pose of the IMU in world (m, quaternion w x y z), velocity (m/s), biases
/// (rad/s, m/s^2); then the standard deviations of rotation (rad, IMU axes), position, velocity and biases;
/// and the rms of the normalised residuals of the frame's image (empty where there is none).
[[nodiscard]] std::string smoothed_states_text(const SmoothedRecording& smoothed);

/// smoothing.json.
[[nodiscard]] std::string to_json(const SmoothedRecording& smoothed, const recording::Recording& recording);

}  // namespace fusebench::batch_estimation
