#include "core/loops/place.hpp"

#include "core/ferns/color_fern_code.hpp"

namespace fusebench::loops {

namespace {

DepthImage every_fourth(const DepthImage& depth_m) {
  DepthImage small(depth_m.width / kDepthStep, depth_m.height / kDepthStep);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) small(x, y) = depth_m(kDepthStep * x, kDepthStep * y);
  }
  return small;
}

GreyImage means_of_blocks(const GreyImage& grey) {
  GreyImage small(grey.width / kDepthStep, grey.height / kDepthStep);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      int sum = 0;
      for (int v = 0; v < kDepthStep; ++v) {
        for (int u = 0; u < kDepthStep; ++u) sum += grey(kDepthStep * x + u, kDepthStep * y + v);
      }
      small(x, y) = static_cast<std::uint8_t>(sum / (kDepthStep * kDepthStep));
    }
  }
  return small;
}

}  // namespace

Place place_of(const RgbdFrame& frame, const PinholeCamera& camera, const config::Config& config) {
  Place place;
  place.timestamp_ns = frame.timestamp_ns;
  place.code = ferns::color_fern_code(frame.color, frame.depth_m);
  place.landmarks = relocalisation::landmarks_of(frame.grey, frame.depth_m, camera, config);
  place.small_depth_m = every_fourth(frame.depth_m);
  place.small_grey = means_of_blocks(frame.grey);
  return place;
}

}  // namespace fusebench::loops
