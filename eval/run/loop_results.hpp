// Loop closures of a run: files, log line and errors.
#pragma once

#include <optional>
#include <string>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/loops/loop_closure.hpp"
#include "eval/loop_error/loop_metrics.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run {

struct LoopResults {
  std::string candidates;                                       ///< loops.csv
  std::string places;                                           ///< places.csv
  std::string log;                                              ///< a line: how many there were
  std::optional<record::Outcome<loop_error::LoopError>> error;  ///< if there is ground truth
};

/// truth: ground truth of the camera at the stamps of the frames, or empty. closure: the loop closure of a
/// system after its last frame; null if the system detects no loops.
[[nodiscard]] LoopResults loop_results(const loops::LoopClosure* closure, const Trajectory& truth,
                                       const PinholeCamera& camera, const config::DepthConfig& depth,
                                       const config::LoopsConfig& loops);

}  // namespace fusebench::run
