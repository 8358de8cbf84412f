// All metrics of one run, from what its frames left behind and what is known of the recording.
#pragma once

#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/sensor_constants.hpp"
#include "core/filter/stamped_state.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "eval/metrics/intensity_readings.hpp"
#include "eval/metrics/residual_metrics.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run {

/// What metrics need of a run.
struct RunOutput {
  bool has_filter = true;  ///< a filter with patches: there are states, covariances, intensities, residuals
  Trajectory trajectory;   ///< frames that were tracked; a predicted pose is no estimate
  std::vector<filter::StampedEstimate> states;  ///< of the same frames, at their capture instants; without a
  ///< filter the instants alone
  std::optional<filter::GaussianState> last_state;  ///< of the last one; none without a filter
  metrics::IntensityAccumulator intensity;
  metrics::IntensityReadingsAccumulator intensity_readings;  ///< empty if they are not asked for
  metrics::ResidualAccumulator residuals;
  Mesh mesh;  ///< of the model, in world
};

/// config: of the run; it says what of a true scene its depth could observe, and whether the body that it
/// estimates is the IMU or the camera.
[[nodiscard]] record::RecordedMetrics metrics_of(const RunOutput& output,
                                                 const recording::Recording& recording,
                                                 const config::Config& config, const Workers& workers);

/// The constants of the sensors after the last tracked frame, as far as they were estimated.
[[nodiscard]] std::vector<filter::SensorConstant> estimated_sensors(const RunOutput& output,
                                                                    const SensorTiming& timing);

}  // namespace fusebench::run
