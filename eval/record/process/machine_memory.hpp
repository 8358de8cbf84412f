// How much memory this machine, or the container that we are in, has left.
#pragma once

#include <cstdint>

namespace fusebench::process {

/// Bytes that can be taken without swapping; a large number where nothing tells.
[[nodiscard]] std::uint64_t available_memory_bytes();

}  // namespace fusebench::process
