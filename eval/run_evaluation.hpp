// All metrics of one run, from what its frames left behind and what is known of the recording.
#pragma once

#include <vector>

#include "core/config.hpp"
#include "core/parallel.hpp"
#include "core/stamped_state.hpp"
#include "core/types.hpp"
#include "datasets/recording.hpp"
#include "eval/intensity_metrics.hpp"
#include "eval/record.hpp"
#include "eval/residual_metrics.hpp"

namespace fusebench {

/// What metrics need of a run.
struct RunOutput {
  Trajectory trajectory;                ///< frames that were tracked; a predicted pose is no estimate
  std::vector<StampedEstimate> states;  ///< of the same frames, at their capture instants
  IntensityAccumulator intensity;
  ResidualAccumulator residuals;
  Mesh mesh;  ///< of the model, in world
};

/// config: of the run; it says what of a true scene its depth could observe, and whether the body that it
/// estimates is the IMU or the camera.
[[nodiscard]] RecordedMetrics metrics_of(const RunOutput& output, const Recording& recording,
                                         const Config& config, const Workers& workers);

}  // namespace fusebench
