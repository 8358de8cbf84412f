// Computes all metrics of one run from the results of its frames and the ground truth of the recording.
#pragma once

#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/sensor_constants.hpp"
#include "core/estimator/filter/stamped_state.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "eval/metrics/intensity_readings.hpp"
#include "eval/metrics/residual_metrics.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run {

/// The input of the metrics.
struct RunOutput {
  bool has_filter = true;  ///< a filter with patches: there are states, covariances, intensities, residuals
  Trajectory trajectory;   ///< poses of tracked frames, without predicted poses
  std::vector<filter::StampedEstimate> states;  ///< of the same frames, at their capture instants; without a
  ///< filter the instants alone
  std::optional<filter::GaussianState> last_state;  ///< of the last one; none without a filter
  metrics::IntensityAccumulator intensity;
  metrics::IntensityReadingsAccumulator intensity_readings;  ///< empty unless requested
  metrics::ResidualAccumulator residuals;
  Mesh mesh;  ///< of the model, in world
};

/// config: of the run; sets which part of the ground-truth mesh is observable by depth, and whether the
/// estimated body is the IMU or the camera.
[[nodiscard]] record::RecordedMetrics metrics_of(const RunOutput& output,
                                                 const recording::Recording& recording,
                                                 const config::Config& config, const Workers& workers);

/// The estimated sensor constants after the last tracked frame.
[[nodiscard]] std::vector<filter::SensorConstant> estimated_sensors(const RunOutput& output,
                                                                    const SensorTiming& timing);

}  // namespace fusebench::run
