// What a place looks like from afar: ferns on a small image of colour and depth. An image of 80 pixels in
// width hardly changes by motion blur that leaves no corner in one of 640.
#pragma once

#include "core/base/image.hpp"
#include "core/ferns/fern_code.hpp"

namespace fusebench::ferns {

/// The tests of a fern are one each on red, green, blue and depth. color and depth_m (0 = no measurement)
/// have one size, at least 80x60. Brightness drops out: colour counts against the mean of the image. Tests
/// are the same in every run and on every machine.
[[nodiscard]] FernCode color_fern_code(const ColorImage& color, const DepthImage& depth_m);

}  // namespace fusebench::ferns
