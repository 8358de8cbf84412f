// Which frames are warped onto which.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/parallel.hpp"
#include "datasets/inspection/inspection.hpp"
#include "datasets/inspection/measures/frame_warp.hpp"

namespace fusebench::inspection {

struct FramePair {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// Up to `count` pairs spread over the recording, of frames that see the same place from different ones (a
/// baseline of about a tenth of the depth, a turn of about 10 deg), and that turn slowly themselves, since
/// rolling shutters and jitter of stamps would show otherwise.
[[nodiscard]] std::vector<FramePair> choose_pairs(const recording::Recording& recording, double depth_m,
                                                  std::size_t count);

/// Loads them. Pairs that cannot be loaded, or have fewer than 100 points, are left out.
[[nodiscard]] std::vector<measures::WarpPair> load_pairs(const recording::Recording& recording,
                                                         const std::vector<FramePair>& pairs,
                                                         const Workers& workers);

}  // namespace fusebench::inspection
