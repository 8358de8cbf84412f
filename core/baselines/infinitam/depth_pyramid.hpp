// Image pyramids whose means exclude pixels without a measurement.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fusebench::baselines::infinitam {

/// Level 0 is the image (metres). A pixel of each further level is the mean of the measured ones of four
/// pixels, 0 if there are none.
[[nodiscard]] std::vector<DepthImage> depth_pyramid(const DepthImage& depth_m, int levels);

/// Level 0 is the image, from 0 to 1. A pixel of each further level is the mean of four.
[[nodiscard]] std::vector<Image<float>> intensity_pyramid(const GreyImage& grey, int levels);

/// The camera of a level. The published program halves all four numbers, an error of at most half a pixel in
/// cx and cy.
[[nodiscard]] PinholeCamera camera_of_level(const PinholeCamera& camera, int level);

}  // namespace fusebench::baselines::infinitam
