// The table of systems, one row for each value of the option system.method.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/base/parallel.hpp"
#include "core/base/replay.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/system/system.hpp"

namespace fusebench::core {

struct SystemRow {
  config::SystemMethod method;
  std::string_view name;      ///< value of system.method
  std::string_view sentence;  ///< description with its source
  std::string_view options;   ///< groups of options that the system reads, separated by blanks
  std::string_view threads;   ///< number of threads, and whether it affects the results
  /// imu: empty for systems without an IMU. The referenced arguments must outlive the system.
  std::unique_ptr<system::System> (*make)(const config::Config& config, const SensorRig& rig,
                                          std::span<const ImuSample> imu, const Workers& workers,
                                          Replay replay);
};

/// All systems in listing order.
[[nodiscard]] std::span<const SystemRow> all_systems();

/// Creates the system of a configuration. replay: as in RecordingEstimator; bundlefusion builds its model
/// with it.
[[nodiscard]] std::unique_ptr<system::System> make_system(const config::Config& config, const SensorRig& rig,
                                                          std::span<const ImuSample> imu,
                                                          const Workers& workers, Replay replay = {});

}  // namespace fusebench::core
