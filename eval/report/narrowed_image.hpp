// Images of the width that a page has for them.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::report {

/// At most so wide, in the same proportions; each pixel is the mean of what it covers.
[[nodiscard]] ColorImage narrowed(const ColorImage& image, int width_px);

}  // namespace fusebench::report
