// Which options of `fusebench eval ate`, `rpe` and `traj` have an effect, by the rest of the command line.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/metrics/trajectory_error/protocol.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::trajectories {

/// What decides whether an option has an effect.
struct OptionContext {
  trajectory_error::TrajectoryRequest request;  ///< with the association that is used
  bool has_stamps = true;
  bool associates = true;  ///< poses of two files are compared
  bool draws = false;
  bool draws_over_distance = false;
};

/// Finds given options of the verb that have no effect. With stamps and evo's protocol each is a warning,
/// because evo accepts them; otherwise the first is an error (usage).
[[nodiscard]] Result<std::vector<std::string>> warnings_of_effects(const CLI::App& verb,
                                                                   const OptionContext& context);

}  // namespace fusebench::cli::trajectories
