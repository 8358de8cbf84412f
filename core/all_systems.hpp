// The table of systems: what the option system.method names.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/base/parallel.hpp"
#include "core/base/replay.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/systems/system.hpp"

namespace fusebench::core {

struct SystemRow {
  config::SystemMethod method;
  std::string_view name;      ///< as system.method spells it
  std::string_view sentence;  ///< what it is, with its source
  std::string_view options;   ///< the groups of options that it reads, separated by blanks
  std::string_view threads;   ///< how many threads it uses, and whether that changes its results
  /// imu: empty for systems without one. What is passed by reference must outlive the system.
  std::unique_ptr<systems::System> (*make)(const config::Config& config, const SensorRig& rig,
                                           std::span<const ImuSample> imu, const Workers& workers,
                                           Replay replay);
};

/// All systems, in the order in which they are listed.
[[nodiscard]] std::span<const SystemRow> all_systems();

/// The system of a configuration. replay: as of RecordingEstimator; bundlefusion makes its model by it.
[[nodiscard]] std::unique_ptr<systems::System> make_system(const config::Config& config, const SensorRig& rig,
                                                           std::span<const ImuSample> imu,
                                                           const Workers& workers, Replay replay = {});

}  // namespace fusebench::core
