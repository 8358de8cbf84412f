// A run of the pipeline as input of a batch estimate: where it was, and what the images said.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/smoother/batch_estimate.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/run/run.hpp"

namespace fusebench::batch_estimation {

struct MeasuredMotion {
  smoother::BatchInput input;           ///< its inertial samples are the recording's, which must outlive it
  std::vector<std::int64_t> stamps_ns;  ///< what outputs call the frames
  std::size_t tracked = 0;
};

/// Runs the pipeline over all frames; the configuration's prior must be the IMU. Errors: those of reading and
/// of the pipeline, with the frame; run_failed (stopped, or more lost frames in a row than
/// iekf.max_lost_frames).
[[nodiscard]] Result<MeasuredMotion> measure_motion(const recording::Recording& recording,
                                                    const config::Config& config, const Workers& workers,
                                                    const run::RunControl& control);

}  // namespace fusebench::batch_estimation
