#include "datasets/recording/exports/quantised_frames.hpp"

#include <cmath>
#include <utility>

namespace fusebench::exports {

Image<std::uint16_t> quantise_depth(const DepthImage& depth_m, const DepthStorage& storage,
                                    DepthCounts& counts) {
  Image<std::uint16_t> values(depth_m.width, depth_m.height);
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    const double depth = depth_m.data[i];
    if (!(depth > 0)) continue;
    ++counts.measured;
    const double value = std::round(depth * storage.units_per_metre);
    if (value < 1 || value > storage.most) {
      ++counts.beyond_range;
    } else {
      values.data[i] = static_cast<std::uint16_t>(value);
    }
  }
  return values;
}

Result<DepthCounts> for_each_frame(const recording::Recording& recording, const DepthStorage& storage,
                                   const std::function<Result<void>(const QuantisedFrame& frame)>& visit) {
  DepthCounts counts;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    auto loaded = recording.load_frame(k);
    if (!loaded) return tl::unexpected(loaded.error());
    const QuantisedFrame frame{k, recording.frames[k], std::move(loaded->color), std::move(loaded->grey),
                               quantise_depth(loaded->depth_m, storage, counts)};
    if (const auto visited = visit(frame); !visited) return tl::unexpected(visited.error());
  }
  return counts;
}

}  // namespace fusebench::exports
