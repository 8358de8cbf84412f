// The volumes of Open3D that fuse RGB-D frames.
#pragma once

#include <vector>

#include "tests/bench/peers/contestant.hpp"

namespace fusebench::peers {

/// Both of them, with colour.
[[nodiscard]] std::vector<Peer> open3d_fusions();

}  // namespace fusebench::peers
