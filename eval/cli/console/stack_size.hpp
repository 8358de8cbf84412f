// Enough stack for the filter's matrices, independent of the limit of the shell.
#pragma once

#include <functional>

namespace fusebench::cli::console {

/// Calls the function and returns its result. Where the stack of the process is limited to less than
/// kLeastStackBytes (`ulimit -s`), this happens in a thread with a stack of kLargeStackBytes, and threads
/// that are created later get as much. Without memory for that, prints a warning. The function must
/// not throw.
int call_with_enough_stack(const std::function<int()>& function);

inline constexpr unsigned long kLeastStackBytes = 4UL << 20;
inline constexpr unsigned long kLargeStackBytes = 16UL << 20;

}  // namespace fusebench::cli::console
