#include "core/baselines/elasticfusion/tracking/plane_matching.hpp"

#include <algorithm>
#include <array>

#include "core/base/simd/lane_points.hpp"
#include "core/baselines/image_rows.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

namespace {

using simd::Float8;
using simd::Int8;

constexpr float kMostApart_m = 0.1F;
constexpr float kMostSine = 0.342020143F;  // sine of 20 degrees
constexpr int kLanes = static_cast<int>(simd::kLanes);

simd::Points gather(const PointMap& map, Int8 at) {
  return {simd::gather(map.x.data.data(), at), simd::gather(map.y.data.data(), at),
          simd::gather(map.z.data.data(), at)};
}

/// Values of a row from x on; 0 beyond its end.
Float8 load_row(const Image<float>& image, int x, int y) {
  const float* const from = image.data.data() + image.index(x, y);
  if (x + kLanes <= image.width) return simd::load(from);
  std::array<float, simd::kLanes> tail{};
  std::copy_n(from, image.width - x, tail.begin());
  return simd::load(tail.data());
}

class PlaneMatcher {
 public:
  PlaneMatcher(const LiveLevel& live, const ViewLevel& view, const SE3& T_view_camera)
      : live_(live),
        view_(view),
        R_(T_view_camera.rotation_matrix().cast<float>()),
        t_(T_view_camera.translation.cast<float>()) {}

  /// Eight pixels of a row from x on.
  void add(int x, int y, PoseSumLanes& sums) const {
    const Float8 depth = load_row(live_.depth_m, x, y);
    const simd::Points live_normal = {load_row(live_.normal.x, x, y), load_row(live_.normal.y, x, y),
                                      load_row(live_.normal.z, x, y)};
    Int8 valid = (depth > 0.0F) & (live_normal.z < 0.0F);
    if (!simd::any(valid)) return;
    const PinholeCamera& camera = live_.camera;
    const Float8 across = (simd::kLaneNumber + (static_cast<float>(x) - static_cast<float>(camera.cx_px))) *
                          static_cast<float>(1 / camera.fx_px);
    const auto down = static_cast<float>((y - camera.cy_px) / camera.fy_px);
    const simd::Points seen = simd::moved(R_, t_, {across * depth, down * depth, depth});
    const Int8 at = place(seen, valid);
    if (!simd::any(valid)) return;
    const simd::Points point = gather(view_.point, at);
    const simd::Points normal = gather(view_.normal, at);
    const simd::Points apart = point - seen;
    const simd::Points sine = simd::cross(simd::rotated(R_, live_normal), normal);
    valid &= (point.z > 0.0F) & (normal.z != 0.0F) &
             (simd::dot(apart, apart) <= kMostApart_m * kMostApart_m) &
             (simd::dot(sine, sine) < kMostSine * kMostSine);
    if (!simd::any(valid)) return;
    const Float8 residual = simd::dot(normal, apart);
    const simd::Points arm = simd::cross(seen, normal);
    sums.add({arm.x, arm.y, arm.z, normal.x, normal.y, normal.z}, residual, simd::all_lanes(1.0F),
             residual * residual, valid);
  }

 private:
  /// Nearest pixel of the view; clears `valid` outside the image.
  [[nodiscard]] Int8 place(const simd::Points& seen, Int8& valid) const {
    const PinholeCamera& camera = view_.camera;
    const auto width = static_cast<float>(camera.width_px), height = static_cast<float>(camera.height_px);
    const Float8 u =
        static_cast<float>(camera.fx_px) * seen.x / seen.z + static_cast<float>(camera.cx_px + 0.5);
    const Float8 v =
        static_cast<float>(camera.fy_px) * seen.y / seen.z + static_cast<float>(camera.cy_px + 0.5);
    valid &= (seen.z > 0.0F) & (u >= 0.0F) & (v >= 0.0F) & (u < width) & (v < height);
    return simd::to_int(simd::clamp(v, 0.0F, height - 1)) * camera.width_px +
           simd::to_int(simd::clamp(u, 0.0F, width - 1));
  }

  const LiveLevel& live_;
  const ViewLevel& view_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
};

}  // namespace

PoseSums match_planes(const LiveLevel& live, const ViewLevel& view, const SE3& T_view_camera,
                      const Workers& workers) {
  const PlaneMatcher matcher(live, view, T_view_camera);
  const auto rows = [&](std::size_t begin, std::size_t end) {
    PoseSumLanes sums;
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < live.depth_m.width; x += kLanes) matcher.add(x, y, sums);
    }
    return sums.total();
  };
  PoseSums sums;
  for (const PoseSums& part :
       workers.map_chunks<PoseSums>(static_cast<std::size_t>(live.depth_m.height), kRowsASum, rows))
    sums += part;
  return sums;
}

}  // namespace fusebench::baselines::elasticfusion::tracking
