// Data of one frame that the next frame is compared with.
#pragma once

#include <cstdint>
#include <vector>

#include "core/estimator/alignment/reference_points.hpp"
#include "core/estimator/patches/patches.hpp"

namespace fusebench::alignment {

struct TrackingReference {
  std::vector<patches::Patch> patches;  ///< cut from the frame
  ReferencePoints points;               ///< points of its coarse levels
  std::int64_t timestamp_ns = 0;        ///< capture instant of the frame
};

}  // namespace fusebench::alignment
