#include "core/estimator/places/ferns/cell_means.hpp"

#include "core/base/error.hpp"

namespace fusebench::ferns {

Image<float> mean_depth_m(const DepthImage& depth_m) {
  check(!depth_m.empty(), "there is an image");
  Image<float> means_m(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    const Cells rows = cells_of(y, kHeight, depth_m.height);
    for (int x = 0; x < kWidth; ++x) {
      const Cells columns = cells_of(x, kWidth, depth_m.width);
      double sum_m = 0;
      int measured = 0;
      for (int v = rows.begin; v < rows.end; ++v) {
        for (int u = columns.begin; u < columns.end; ++u) {
          sum_m += static_cast<double>(depth_m(u, v));
          measured += depth_m(u, v) > 0 ? 1 : 0;
        }
      }
      means_m(x, y) = measured > 0 ? static_cast<float>(sum_m / measured) : 0.0F;
    }
  }
  return means_m;
}

}  // namespace fusebench::ferns
