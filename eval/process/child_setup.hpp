// What every child does first.
#pragma once

#include <sys/types.h>

#include <cstdint>

namespace fusebench::process {

/// In a child that was just forked: it dies with `parent`, has a process group of its own (Ctrl-C is for the
/// parent, which asks its children in its turn), reads nothing, writes standard output and error to `output`,
/// leaves no core, and has at most so many bytes of data (0: no limit).
void set_up_child(pid_t parent, int output, std::uint64_t memory_bytes);

}  // namespace fusebench::process
