#include "core/estimator/patches/patch_deformation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <optional>

#include "core/base/bits.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::patches {

namespace {

/// Level-0 coordinates from the key of a pixel.
Vector2d reference_coordinates(const PatchPixel& pixel, const PinholeCamera& camera) {
  const auto width = static_cast<std::uint32_t>(camera.width_px);
  return {static_cast<double>(pixel.reference_pixel % width),
          static_cast<double>(pixel.reference_pixel / width)};
}

/// The model point nearest to the patch centre at level 0, at most one pixel away.
std::optional<Vector3d> centre_point_world(const Patch& patch, const PinholeCamera& camera) {
  double nearest = 2.1;  // squared pixels: a neighbour (of four or eight) may replace the centre
  std::optional<Vector3d> result;
  for (const PatchPixel& pixel : patch.levels.front().pixels) {
    const double distance =
        (reference_coordinates(pixel, camera) - patch.centre_px.cast<double>()).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      result = pixel.point_world;
    }
  }
  return result;
}

/// Least-squares plane of the patch at level 0. In a pinhole image, 1/z = a u + b v + c for a plane.
std::optional<Vector3d> inverse_depth_plane(const Patch& patch, const PinholeCamera& camera,
                                            const SE3& T_camera_world) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const PatchPixel& pixel : patch.levels.front().pixels) {
    const Vector2d offset = reference_coordinates(pixel, camera) - patch.centre_px.cast<double>();
    const Vector3d row(offset.x(), offset.y(), 1.0);
    normal += row * row.transpose();
    right += row / (T_camera_world * pixel.point_world).z();
  }
  const Eigen::LDLT<Matrix3d> solver(normal);
  // Fewer than three pixels, or collinear ones, do not determine a plane.
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < 1e-6) return std::nullopt;
  return solver.solve(right);
}

void warp_rigidly(Patch& patch, const PinholeCamera& camera) {
  const std::optional<Vector3d> centre = centre_point_world(patch, camera);
  for (std::size_t l = 0; l < patch.levels.size(); ++l) {
    auto& [pixels, warp_points] = patch.levels[l];
    if (!centre) pixels.clear();
    for (const PatchPixel& pixel : pixels) {
      const Vector2d offset_px = reference_coordinates(pixel, camera) - patch.centre_px.cast<double>();
      warp_points.push_back({*centre, offset_px / static_cast<double>(1 << l)});
    }
  }
}

void warp_by_plane(Patch& patch, const PinholeCamera& camera, const SE3& T_world_camera) {
  const std::optional<Vector3d> plane = inverse_depth_plane(patch, camera, T_world_camera.inverse());
  for (PatchLevel& level : patch.levels) {
    if (!plane) level.pixels.clear();
    std::vector<PatchPixel> kept;
    for (const PatchPixel& pixel : level.pixels) {
      const Vector2d place = reference_coordinates(pixel, camera);
      const Vector2d offset = place - patch.centre_px.cast<double>();
      const double inverse_depth = plane->dot(Vector3d(offset.x(), offset.y(), 1.0));
      if (inverse_depth <= 0) continue;  // the plane is behind the camera here
      level.warp_points.push_back(
          {T_world_camera * camera.back_project(place.x(), place.y(), 1.0 / inverse_depth),
           Vector2d::Zero()});
      kept.push_back(pixel);
    }
    level.pixels = std::move(kept);
  }
}

}  // namespace

void set_deformation(Patch& patch, const PinholeCamera& camera, const SE3& T_world_camera,
                     config::Deformation deformation) {
  for (PatchLevel& level : patch.levels) level.warp_points.clear();
  switch (deformation) {
    case config::Deformation::pixelwise:
      return;
    case config::Deformation::planar:
      warp_by_plane(patch, camera, T_world_camera);
      return;
    case config::Deformation::rigid_square:
      warp_rigidly(patch, camera);
      return;
  }
}

void warp_level(std::span<const PixelLanes> pixels, std::span<const WarpPointLanes> warp_points,
                const PosedLanes& camera, std::span<WarpedLanes> warped) {
  constexpr float kMinDepthM = 0.05F;  // closer points have an ill-conditioned projection
  const auto right = static_cast<float>(camera.width_px - 2);
  const auto bottom = static_cast<float>(camera.height_px - 2);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    WarpedLanes& w = warped[i];
    const simd::Points own = camera.to_camera(pixels[i].point);
    const simd::Points point = warp_points.empty() ? own : camera.to_camera(warp_points[i].point);
    const simd::Int8 in_front = point.z >= kMinDepthM;
    const simd::Float8 inverse_z = 1.0F / (in_front ? point.z : simd::all_lanes(1.0F));
    w.x = simd::multiply_add(camera.fx_px * point.x, inverse_z, simd::all_lanes(camera.cx_px));
    w.y = simd::multiply_add(camera.fy_px * point.y, inverse_z, simd::all_lanes(camera.cy_px));
    if (!warp_points.empty()) {
      w.x += warp_points[i].offset_x;
      w.y += warp_points[i].offset_y;
    }
    w.depth_m = own.z;
    w.in_image =
        pixels[i].present & in_front & (w.x >= 1.0F) & (w.y >= 1.0F) & (w.x <= right) & (w.y <= bottom);
    w.visible = w.in_image;
    w.covered = simd::Int8{};
  }
}

namespace {

/// Index of the nearest pixel; 0 if `inside` is false.
simd::Int8 nearest_pixel(simd::Float8 x, simd::Float8 y, int width_px, simd::Int8 inside) {
  return inside ? simd::to_int(y + 0.5F) * width_px + simd::to_int(x + 0.5F) : simd::Int8{};
}

}  // namespace

void MutualOcclusion::resize(int width_px, int height_px) {
  width_px_ = width_px;
  nearest_m_.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                    std::numeric_limits<float>::infinity());
}

void MutualOcclusion::test(std::span<WarpedLanes> warped, const config::DepthConfig& depth,
                           config::ShrinkTest rule) {
  const auto for_cells_in_image = [&](const auto& visit) {
    for (const WarpedLanes& w : warped) {
      const simd::Int8 cell = nearest_pixel(w.x, w.y, width_px_, w.in_image);
      for_each_bit(simd::lane_bits(w.in_image), [&](std::size_t lane) {
        visit(nearest_m_[static_cast<std::size_t>(cell[lane])], w.depth_m[lane]);
      });
    }
  };
  for_cells_in_image([](float& nearest_m, float depth_m) { nearest_m = std::min(nearest_m, depth_m); });
  // Pixels of one surface also collide when the camera moves backwards. Only a clear difference in depth is
  // an occlusion.
  const bool any = rule == config::ShrinkTest::any_collision;
  const float sigmas = any ? 0.0F : 3.0F;
  const auto jump = any ? 0.0F : static_cast<float>(depth.edge_jump);
  for (WarpedLanes& w : warped) {
    const simd::Int8 cell = nearest_pixel(w.x, w.y, width_px_, w.in_image);
    const simd::Float8 front_m = w.in_image ? simd::gather(nearest_m_.data(), cell) : w.depth_m;
    const simd::Float8 tolerance_m =
        simd::max(sigmas * preprocessing::depth_sigma_m(front_m, depth), jump * front_m);
    w.visible &= w.depth_m <= front_m + tolerance_m;
  }
  for_cells_in_image([](float& nearest_m, float) { nearest_m = std::numeric_limits<float>::infinity(); });
}

void test_measured_occlusion(std::span<WarpedLanes> warped, const DepthImage& depth_m, int scale,
                             double tolerance_m, const config::DepthConfig& depth) {
  const auto factor = static_cast<float>(scale);
  const auto right = static_cast<float>(depth_m.width) - 0.5F;
  const auto bottom = static_cast<float>(depth_m.height) - 0.5F;
  for (WarpedLanes& w : warped) {
    const simd::Float8 x = w.x * factor;
    const simd::Float8 y = w.y * factor;
    const simd::Int8 inside = w.visible & (x < right) & (y < bottom);
    const simd::Float8 measured_m =
        simd::gather(depth_m.data.data(), nearest_pixel(x, y, depth_m.width, inside));
    // A pixel without a measurement is not tested.
    const simd::Int8 judged = inside & (measured_m > 0.0F);
    const simd::Float8 allowed_m = simd::max(simd::all_lanes(static_cast<float>(tolerance_m)),
                                             3.0F * preprocessing::depth_sigma_m(measured_m, depth));
    const simd::Float8 behind_m = w.depth_m - measured_m;
    w.covered = judged & (behind_m > allowed_m);
    w.visible &= ~judged | (simd::abs(behind_m) <= allowed_m);
  }
}

bool is_extended(std::span<const WarpedLanes> warped, int size_px) {
  const simd::Float8 far = simd::all_lanes(std::numeric_limits<float>::infinity());
  simd::Float8 left = far, top = far, right = -far, bottom = -far;
  for (const WarpedLanes& w : warped) {
    left = simd::min(left, w.visible ? w.x : far);
    right = simd::max(right, w.visible ? w.x : -far);
    top = simd::min(top, w.visible ? w.y : far);
    bottom = simd::max(bottom, w.visible ? w.y : -far);
  }
  const auto extent = [](simd::Float8 low, simd::Float8 high) {
    float from = low[0];
    float to = high[0];
    for (std::size_t lane = 1; lane < simd::kLanes; ++lane) {
      from = std::min(from, low[lane]);
      to = std::max(to, high[lane]);
    }
    return to - from;  // negative if no pixel is visible
  };
  // The pixel centres of the square span size - 1; an extension is at least one pixel more.
  return std::max(extent(left, right), extent(top, bottom)) >= static_cast<float>(size_px);
}

}  // namespace fusebench::patches
