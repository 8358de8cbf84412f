// Images of half the size, by the rule that skips what was not measured.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fusebench::systems::infinitam {

/// Level 0 is the image (metres); a pixel of each further one is the mean of those of four that were
/// measured, 0 where none was.
[[nodiscard]] std::vector<DepthImage> depth_pyramid(const DepthImage& depth_m, int levels);

/// Level 0 is the image, from 0 to 1; a pixel of each further one is the mean of four.
[[nodiscard]] std::vector<Image<float>> intensity_pyramid(const GreyImage& grey, int levels);

/// The camera of a level. The program halves all four numbers, which is half a pixel off in cx and cy at
/// most.
[[nodiscard]] PinholeCamera camera_of_level(const PinholeCamera& camera, int level);

}  // namespace fusebench::systems::infinitam
