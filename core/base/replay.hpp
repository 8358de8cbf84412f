// The frames of a recording once more, for what changes the poses of frames that it has seen.
#pragma once

#include <functional>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench {

using FrameVisitor = std::function<Result<void>(const RgbdFrame& frame)>;

/// Calls the visitor with every frame of the recording up to the newest one that was processed, in order.
/// Errors: the first one of the visitor, which ends the replay, and those of reading a frame.
using Replay = std::function<Result<void>(const FrameVisitor& visit)>;

}  // namespace fusebench
