// Image of points or directions.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::baselines {

/// One image for each coordinate, for access by lanes.
struct PointMap {
  Image<float> x;
  Image<float> y;
  Image<float> z;

  void resize(int width_px, int height_px) {
    for (Image<float>* const image : {&x, &y, &z}) image->resize(width_px, height_px);
  }
  [[nodiscard]] Eigen::Vector3f at(std::size_t pixel) const {
    return {x.data[pixel], y.data[pixel], z.data[pixel]};
  }
  void put(std::size_t pixel, const Eigen::Vector3f& value) {
    x.data[pixel] = value.x();
    y.data[pixel] = value.y();
    z.data[pixel] = value.z();
  }
};

}  // namespace fusebench::baselines
