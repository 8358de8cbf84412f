// Appearance of a place by depth alone: ferns on a small depth image. For images without usable colour
// (darkness, motion blur).
#pragma once

#include "core/base/image.hpp"
#include "core/estimator/places/ferns/fern_code.hpp"

namespace fusebench::ferns {

/// All tests of a fern are on depth (metres, 0 = no measurement) of an image of any size. The tests are fixed
/// on all machines.
[[nodiscard]] FernCode depth_fern_code(const DepthImage& depth_m);

}  // namespace fusebench::ferns
