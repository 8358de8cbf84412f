#include "core/baselines/infinitam/depth_matching.hpp"

#include <algorithm>
#include <vector>

#include "core/base/simd/lane_points.hpp"
#include "core/baselines/image_rows.hpp"

namespace fusebench::baselines::infinitam {

namespace {

/// A camera and its pose in single precision.
struct PosedCamera {
  PosedCamera(const PinholeCamera& camera, const SE3& T_a_b)
      : fx(static_cast<float>(camera.fx_px)),
        fy(static_cast<float>(camera.fy_px)),
        cx(static_cast<float>(camera.cx_px)),
        cy(static_cast<float>(camera.cy_px)),
        R(T_a_b.rotation_matrix().cast<float>()),
        t(T_a_b.translation.cast<float>()) {}

  float fx, fy, cx, cy;
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
};

/// Four neighbours of a position with bilinear weights.
struct Neighbours {
  std::array<simd::Int8, 4> at;
  std::array<simd::Float8, 4> share;

  Neighbours(simd::Float8 x, simd::Float8 y, int width) {
    const simd::Int8 left = simd::to_int(x), top = simd::to_int(y);
    const simd::Float8 dx = x - simd::to_float(left), dy = y - simd::to_float(top);
    const simd::Int8 first = top * width + left;
    at = {first, first + 1, first + width, first + width + 1};
    share = {(1.0F - dx) * (1.0F - dy), dx * (1.0F - dy), (1.0F - dx) * dy, dx * dy};
  }

  [[nodiscard]] simd::Float8 of(const Image<float>& image) const {
    simd::Float8 sum{};
    for (std::size_t i = 0; i < at.size(); ++i)
      sum = simd::multiply_add(share[i], simd::gather(image.data.data(), at[i]), sum);
    return sum;
  }
  [[nodiscard]] simd::Points of(const PointMap& map) const { return {of(map.x), of(map.y), of(map.z)}; }
  /// True if all four values are at least 0.
  [[nodiscard]] simd::Int8 all_there(const Image<float>& image) const {
    simd::Int8 there = simd::all_lanes(-1);
    for (const simd::Int8 place : at) there &= simd::gather(image.data.data(), place) >= 0.0F;
    return there;
  }
};

class DepthMatcher {
 public:
  DepthMatcher(const PinholeCamera& camera, const SE3& T_world_camera, const ModelView& view,
               const DepthMatching& matching)
      : camera_(camera, T_world_camera),
        view_(view),
        view_camera_(view.camera, view.T_world_camera.inverse()),
        matching_(matching) {}

  /// Adds eight pixels of a row from x on; skips pixels from `columns` on.
  void add(const float* depth_m, int x, int y, int columns, PoseSumLanes& sums) const {
    const simd::Float8 u = simd::kLaneNumber + static_cast<float>(x);
    const simd::Float8 depth = simd::load(depth_m);
    simd::Int8 valid = (depth > 1e-8F) & (u < static_cast<float>(columns));
    if (!simd::any(valid)) return;
    const simd::Points point_camera = {depth * ((u - camera_.cx) / camera_.fx),
                                       depth * ((static_cast<float>(y) - camera_.cy) / camera_.fy), depth};
    const simd::Points point = simd::moved(camera_.R, camera_.t, point_camera);
    const simd::Points seen = simd::moved(view_camera_.R, view_camera_.t, point);
    const simd::Float8 px = view_camera_.fx * seen.x / seen.z + view_camera_.cx;
    const simd::Float8 py = view_camera_.fy * seen.y / seen.z + view_camera_.cy;
    const auto right = static_cast<float>(view_.camera.width_px - 2);
    const auto bottom = static_cast<float>(view_.camera.height_px - 2);
    valid &= (seen.z > 0.0F) & (px >= 0.0F) & (px <= right) & (py >= 0.0F) & (py <= bottom);
    if (!simd::any(valid)) return;
    const Neighbours around(simd::clamp(px, 0.0F, right), simd::clamp(py, 0.0F, bottom),
                            view_.camera.width_px);
    const simd::Points apart = around.of(view_.point) - point;
    valid &= around.all_there(view_.weight) &
             (simd::dot(apart, apart) <= static_cast<float>(matching_.max_squared_distance_m2));
    if (!simd::any(valid)) return;
    const simd::Points normal = around.of(view_.normal);
    simd::Float8 weight = simd::all_lanes(1.0F);
    if (matching_.huber_m > 0) weight = weight_of(depth, around, valid);
    add_residual(simd::dot(normal, apart), simd::cross(point, normal), normal, weight, valid, sums);
  }

 private:
  simd::Float8 weight_of(simd::Float8 depth_m, const Neighbours& around, simd::Int8& valid) const {
    const auto near = static_cast<float>(matching_.near_m);
    const auto reach = static_cast<float>(matching_.far_m - matching_.near_m);
    const simd::Float8 left = simd::max(simd::all_lanes(0.0F), 1.0F - (depth_m - near) / reach);
    simd::Float8 weight = left * left;
    if (matching_.by_weight) {
      const auto skipped = static_cast<float>(matching_.weight_to_skip);
      const simd::Float8 surface = around.of(view_.weight);
      valid &= surface >= skipped;
      weight *= (surface - skipped) / static_cast<float>(matching_.weight_to_count);
    }
    return weight;
  }

  void add_residual(simd::Float8 residual_m, const simd::Points& arm, const simd::Points& normal,
                    simd::Float8 weight, simd::Int8 valid, PoseSumLanes& sums) const {
    const std::array<simd::Float8, 6> direction = {arm.x, arm.y, arm.z, normal.x, normal.y, normal.z};
    if (matching_.huber_m <= 0) {
      sums.add(direction, residual_m, simd::all_lanes(1.0F), residual_m * residual_m, valid);
      return;
    }
    const auto huber = static_cast<float>(matching_.huber_m);
    const simd::Float8 size = simd::abs(residual_m);
    const simd::Float8 beyond = simd::max(simd::all_lanes(0.0F), size - huber);
    const simd::Float8 cost = residual_m * residual_m - beyond * beyond;
    const simd::Float8 first = 2.0F * simd::clamp(residual_m, -huber, huber);
    const simd::Float8 second = size < huber ? simd::all_lanes(2.0F) : simd::all_lanes(0.0F);
    sums.add(direction, weight * first, weight * second, weight * cost, valid);
  }

  PosedCamera camera_;
  const ModelView& view_;
  PosedCamera view_camera_;
  const DepthMatching& matching_;
};

}  // namespace

PoseSums match_depth(const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera,
                     const ModelView& view, const DepthMatching& matching, const Workers& workers) {
  const DepthMatcher matcher(camera, T_world_camera, view, matching);
  const auto rows = [&](std::size_t begin, std::size_t end) {
    PoseSumLanes sums;
    std::array<float, simd::kLanes> tail{};
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const float* const row = depth_m.data.data() + depth_m.index(0, y);
      for (int x = 0; x < depth_m.width; x += static_cast<int>(simd::kLanes)) {
        const int left = depth_m.width - x;
        const float* pixels = row + x;
        if (left < static_cast<int>(simd::kLanes)) {
          std::copy_n(pixels, left, tail.begin());
          pixels = tail.data();
        }
        matcher.add(pixels, x, y, depth_m.width, sums);
      }
    }
    return sums.total();
  };
  PoseSums sums;
  for (const PoseSums& part :
       workers.map_chunks<PoseSums>(static_cast<std::size_t>(depth_m.height), kRowsASum, rows))
    sums += part;
  return sums;
}

}  // namespace fusebench::baselines::infinitam
