// A run of the pipeline as input of a batch estimate: where it was, and what the images said.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/smoother/batch_estimate.hpp"
#include "datasets/recording.hpp"
#include "eval/run.hpp"

namespace fusebench {

struct MeasuredMotion {
  BatchInput input;                     ///< its inertial samples are the recording's, which must outlive it
  std::vector<std::int64_t> stamps_ns;  ///< what outputs call the frames
  std::size_t tracked = 0;
};

/// Runs the pipeline over all frames; the configuration's prior must be the IMU. Errors: those of reading and
/// of the pipeline, with the frame; run_failed (stopped, or more lost frames in a row than
/// iekf.max_lost_frames).
[[nodiscard]] Result<MeasuredMotion> measure_motion(const Recording& recording, const Config& config,
                                                    const Workers& workers, const RunControl& control);

}  // namespace fusebench
