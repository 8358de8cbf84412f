#include "core/baselines/image_gradient.hpp"

namespace fusebench::baselines {

Gradient gradient_of(const Image<float>& image) {
  Gradient gradient{Image<float>(image.width, image.height), Image<float>(image.width, image.height)};
  for (int y = 1; y + 1 < image.height; ++y) {
    const float* const above = image.data.data() + image.index(0, y - 1);
    const float* const here = image.data.data() + image.index(0, y);
    const float* const below = image.data.data() + image.index(0, y + 1);
    float* const dx = gradient.dx.data.data() + image.index(0, y);
    float* const dy = gradient.dy.data.data() + image.index(0, y);
    for (int x = 1; x + 1 < image.width; ++x) {
      dx[x] =
          ((above[x + 1] - above[x - 1]) + 2 * (here[x + 1] - here[x - 1]) + (below[x + 1] - below[x - 1])) /
          8.0F;
      dy[x] =
          ((below[x - 1] - above[x - 1]) + 2 * (below[x] - above[x]) + (below[x + 1] - above[x + 1])) / 8.0F;
    }
  }
  return gradient;
}

}  // namespace fusebench::baselines
