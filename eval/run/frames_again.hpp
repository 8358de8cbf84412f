// Frames that a system has seen, once more for its model: after it has corrected its poses.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "core/systems/system.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"

namespace fusebench::run {

/// The first `count` frames of the run, in order, to System::fuse_again(). Errors: run_failed (a stop), those
/// of the recording and of the system.
[[nodiscard]] Result<void> fuse_again(const PreparedRun& run, std::size_t count, systems::System& system,
                                      const RunControl& control);

}  // namespace fusebench::run
