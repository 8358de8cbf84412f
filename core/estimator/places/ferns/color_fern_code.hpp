// Appearance of a place: ferns on a small image of colour and depth. Motion blur that removes all corners of
// an image of 640 pixels in width hardly changes one of 80 pixels.
#pragma once

#include "core/base/image.hpp"
#include "core/estimator/places/ferns/fern_code.hpp"

namespace fusebench::ferns {

/// Each fern has one test on each of red, green, blue and depth. color and depth_m (0 = no measurement) have
/// one size, at least 80x60. Colour is divided by the mean of the image, so brightness has no effect. The
/// tests are fixed on all machines.
[[nodiscard]] FernCode color_fern_code(const ColorImage& color, const DepthImage& depth_m);

}  // namespace fusebench::ferns
