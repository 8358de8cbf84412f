// The RGB-D odometries of OpenCV's contributed modules.
#pragma once

#include <vector>

#include "tests/bench/peers/contestant.hpp"

namespace fusebench::peers {

/// Frame to frame, with the library's default options.
[[nodiscard]] std::vector<Peer> opencv_odometries();

}  // namespace fusebench::peers
