// Derivatives of an image.
#pragma once

#include "core/base/image.hpp"

namespace fusebench::baselines {

/// Gradient of an image by Sobel's filter (per pixel), 0 at the border.
struct Gradient {
  Image<float> dx;
  Image<float> dy;
};
[[nodiscard]] Gradient gradient_of(const Image<float>& image);

}  // namespace fusebench::baselines
