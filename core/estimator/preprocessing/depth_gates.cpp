#include "core/estimator/preprocessing/depth_gates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fusebench::preprocessing {

namespace {

/// Gates one row, given the previous, own and next row. Without branches, so that the compiler can vectorise
/// it.
void gate_row(const std::array<const float*, 3>& rows_m, int width, const config::DepthConfig& config,
              float* gated_m) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const auto nearest = static_cast<float>(config.min_m);
  const auto farthest = static_cast<float>(config.max_m);
  const auto jump = static_cast<float>(config.edge_jump);
  const float* const above_m = rows_m[0];
  const float* const middle_m = rows_m[1];
  const float* const below_m = rows_m[2];
#pragma GCC ivdep
  for (int x = 1; x < width - 1; ++x) {
    const float z = middle_m[x];
    float low = kFar;
    float high = 0.0F;
    const auto take = [&](float neighbour) {
      const float from_below = neighbour > 0.0F ? neighbour : kFar;
      const float from_above = neighbour > 0.0F ? neighbour : 0.0F;
      low = from_below < low ? from_below : low;
      high = from_above > high ? from_above : high;
    };
    take(above_m[x - 1]);
    take(above_m[x]);
    take(above_m[x + 1]);
    take(middle_m[x - 1]);
    take(middle_m[x + 1]);
    take(below_m[x - 1]);
    take(below_m[x]);
    take(below_m[x + 1]);
    const float allowed = jump * z;
    const bool trusted = (z >= nearest) & (z <= farthest) & !(z - low > allowed) & !(high - z > allowed);
    gated_m[x] = trusted ? z : 0.0F;
  }
}

}  // namespace

void gate_depth(const DepthImage& depth_m, const config::DepthConfig& config, DepthImage& gated_m) {
  gated_m.resize(depth_m.width, depth_m.height);
  const auto row_of = [&](int y) { return &depth_m.data[depth_m.index(0, y)]; };
  for (int y = 0; y < depth_m.height; ++y) {
    float* const gated_row_m = &gated_m.data[gated_m.index(0, y)];
    if (y == 0 || y + 1 == depth_m.height) {
      std::fill_n(gated_row_m, depth_m.width, 0.0F);
      continue;
    }
    gated_row_m[0] = 0.0F;
    gate_row({row_of(y - 1), row_of(y), row_of(y + 1)}, depth_m.width, config, gated_row_m);
    gated_row_m[depth_m.width - 1] = 0.0F;
  }
}

bool is_one_surface(const DepthImage& depth_m, int x, int y, int reach_px, double edge_jump) {
  const float middle_m = depth_m(x, y);
  if (middle_m <= 0) return false;
  if (reach_px == 0) return true;
  const bool inside =
      depth_m.contains(x - reach_px, y - reach_px) && depth_m.contains(x + reach_px, y + reach_px);
  for (int dy = -reach_px; dy <= reach_px; dy += reach_px) {
    for (int dx = -reach_px; dx <= reach_px; dx += reach_px) {
      if (!inside && !depth_m.contains(x + dx, y + dy)) continue;
      const float m = depth_m(x + dx, y + dy);
      if (m <= 0 || std::abs(m - middle_m) > edge_jump * middle_m) return false;
    }
  }
  return true;
}

}  // namespace fusebench::preprocessing
