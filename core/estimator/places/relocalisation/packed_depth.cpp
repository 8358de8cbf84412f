#include "core/estimator/places/relocalisation/packed_depth.hpp"

#include <algorithm>
#include <limits>

namespace fusebench::relocalisation {

PackedDepth::PackedDepth(const DepthImage& depth_m) : steps_(depth_m.width, depth_m.height) {
  if (depth_m.empty()) return;
  constexpr float kMostSteps = std::numeric_limits<std::uint16_t>::max();
  step_m_ = *std::max_element(depth_m.data.begin(), depth_m.data.end()) / kMostSteps;
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    if (!(depth_m.data[i] > 0)) continue;
    const float steps = std::clamp(depth_m.data[i] / step_m_ + 0.5F, 1.0F, kMostSteps);
    steps_.data[i] = static_cast<std::uint16_t>(steps);
  }
}

DepthImage PackedDepth::unpacked_m() const {
  DepthImage depth_m(steps_.width, steps_.height);
  for (std::size_t i = 0; i < steps_.data.size(); ++i)
    depth_m.data[i] = static_cast<float>(steps_.data[i]) * step_m_;
  return depth_m;
}

}  // namespace fusebench::relocalisation
