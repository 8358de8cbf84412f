// Second pass over the frames of a recording, for systems that correct the poses of earlier frames.
#pragma once

#include <functional>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench {

using FrameVisitor = std::function<Result<void>(const RgbdFrame& frame)>;

/// Calls the visitor with each frame of the recording, in order, up to the newest processed one. Errors: the
/// first one of the visitor, which ends the replay, and errors of reading a frame.
using Replay = std::function<Result<void>(const FrameVisitor& visit)>;

}  // namespace fusebench
