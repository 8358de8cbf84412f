#include "core/estimator/places/small_images.hpp"

namespace fusebench::places {

namespace {

DepthImage every_fourth(const DepthImage& depth_m) {
  DepthImage small(depth_m.width / kSmallStep, depth_m.height / kSmallStep);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) small(x, y) = depth_m(kSmallStep * x, kSmallStep * y);
  }
  return small;
}

GreyImage means_of_blocks(const GreyImage& grey) {
  GreyImage small(grey.width / kSmallStep, grey.height / kSmallStep);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      int sum = 0;
      for (int v = 0; v < kSmallStep; ++v) {
        for (int u = 0; u < kSmallStep; ++u) sum += grey(kSmallStep * x + u, kSmallStep * y + v);
      }
      small(x, y) = static_cast<std::uint8_t>(sum / (kSmallStep * kSmallStep));
    }
  }
  return small;
}

}  // namespace

SmallImages small_images_of(const GreyImage& grey, const DepthImage& depth_m) {
  return {every_fourth(depth_m), means_of_blocks(grey)};
}

}  // namespace fusebench::places
