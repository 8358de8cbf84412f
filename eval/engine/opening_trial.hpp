// Whether a recording can be opened, found out in a process that may hang or take too much.
#pragma once

#include <atomic>
#include <functional>

#include "core/base/error.hpp"
#include "eval/suites/run_selection.hpp"

namespace fusebench::engine {

/// Calls `open` in a child, within the limits of a run; where they set none for memory, within what the
/// machine has. Reading counts as progress, so that a large recording is not taken for one that hangs, as on
/// a network folder whose server is gone. This process opens the recording once more then, from the system's
/// cache of files. Errors: those of `open`; run_failed if the child hung, crashed or took too much, or was
/// stopped; io if there can be no child.
[[nodiscard]] Result<void> try_opening(const std::function<Result<void>()>& open,
                                       const suites::RunLimits& limits, const std::atomic<bool>* stop);

}  // namespace fusebench::engine
