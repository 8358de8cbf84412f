// What a place looks like from afar by its depth alone: ferns on a small image of it. For images that
// darkness or motion blur leave no colour to ask about.
#pragma once

#include "core/base/image.hpp"
#include "core/ferns/fern_code.hpp"

namespace fusebench::ferns {

/// All tests of a fern are on depth (metres, 0 = no measurement), of an image of any size. Tests are the same
/// in every run and on every machine.
[[nodiscard]] FernCode depth_fern_code(const DepthImage& depth_m);

}  // namespace fusebench::ferns
