#include "core/patch_deformation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/depth_gates.hpp"

namespace fusebench {

namespace {

/// Level-0 coordinates of a pixel from its key.
Vector2d reference_coordinates(const PatchPixel& pixel, const PinholeCamera& camera) {
  const auto width = static_cast<std::uint32_t>(camera.width_px);
  return {static_cast<double>(pixel.reference_pixel % width),
          static_cast<double>(pixel.reference_pixel / width)};
}

/// The model point nearest to the patch centre at level 0, within one pixel of it.
std::optional<Vector3d> centre_point_world(const Patch& patch, const PinholeCamera& camera) {
  double nearest = 2.1;  // squared pixels: the four or eight neighbours of the centre may stand in for it
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

/// Least-squares plane of the patch at level 0. In a pinhole image a plane is affine in inverse depth: 1/z =
/// a u + b v + c.
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
  // Fewer than three pixels, or all in a line, do not make a plane.
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < 1e-6) return std::nullopt;
  return solver.solve(right);
}

void warp_rigidly(Patch& patch, const PinholeCamera& camera) {
  const std::optional<Vector3d> centre = centre_point_world(patch, camera);
  for (std::size_t l = 0; l < patch.levels.size(); ++l) {
    auto& pixels = patch.levels[l].pixels;
    if (!centre) pixels.clear();
    for (PatchPixel& pixel : pixels) {
      pixel.warp_point_world = *centre;
      pixel.warp_offset_px = (reference_coordinates(pixel, camera) - patch.centre_px.cast<double>()) /
                             static_cast<double>(1 << l);
    }
  }
}

void warp_by_plane(Patch& patch, const PinholeCamera& camera, const SE3& T_world_camera) {
  const std::optional<Vector3d> plane = inverse_depth_plane(patch, camera, T_world_camera.inverse());
  for (PatchLevel& level : patch.levels) {
    if (!plane) level.pixels.clear();
    std::vector<PatchPixel> kept;
    for (PatchPixel& pixel : level.pixels) {
      const Vector2d place = reference_coordinates(pixel, camera);
      const Vector2d offset = place - patch.centre_px.cast<double>();
      const double inverse_depth = plane->dot(Vector3d(offset.x(), offset.y(), 1.0));
      if (inverse_depth <= 0) continue;  // the plane passes behind the camera here
      pixel.warp_point_world =
          T_world_camera * camera.back_project(place.x(), place.y(), 1.0 / inverse_depth);
      kept.push_back(pixel);
    }
    level.pixels = std::move(kept);
  }
}

}  // namespace

void set_deformation(Patch& patch, const PinholeCamera& camera, const SE3& T_world_camera,
                     Deformation deformation) {
  switch (deformation) {
    case Deformation::pixelwise:
      for (PatchLevel& level : patch.levels) {
        for (PatchPixel& pixel : level.pixels) pixel.warp_point_world = pixel.point_world;
      }
      return;
    case Deformation::planar:
      warp_by_plane(patch, camera, T_world_camera);
      return;
    case Deformation::rigid_square:
      warp_rigidly(patch, camera);
      return;
  }
}

std::vector<WarpedPixel> warp_level(const PatchLevel& level, const PosedCamera& posed) {
  constexpr double kMinDepthM = 0.05;  // closer points project wildly
  std::vector<WarpedPixel> warped(level.pixels.size());
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const PatchPixel& pixel = level.pixels[i];
    WarpedPixel& w = warped[i];
    w.warp_point_camera = posed.to_camera(pixel.warp_point_world);
    w.depth_m = posed.to_camera(pixel.point_world).z();
    if (w.warp_point_camera.z() < kMinDepthM) continue;
    w.pixel_px = posed.camera.project(w.warp_point_camera) + pixel.warp_offset_px;
    w.in_image = w.pixel_px.x() >= 1 && w.pixel_px.y() >= 1 && w.pixel_px.x() <= posed.camera.width_px - 2 &&
                 w.pixel_px.y() <= posed.camera.height_px - 2;
    w.visible = w.in_image;
  }
  return warped;
}

void test_mutual_occlusion(std::span<std::vector<WarpedPixel>> warped, int width_px, int height_px,
                           const DepthConfig& depth) {
  DepthImage nearest_m(width_px, height_px, std::numeric_limits<float>::infinity());
  const auto cell = [&](const WarpedPixel& w) -> float& {
    return nearest_m(static_cast<int>(std::lround(w.pixel_px.x())),
                     static_cast<int>(std::lround(w.pixel_px.y())));
  };
  for (const auto& patch : warped) {
    for (const WarpedPixel& w : patch) {
      if (w.in_image) cell(w) = std::min(cell(w), static_cast<float>(w.depth_m));
    }
  }
  // Pixels of one surface also collide, when the camera backs away: only a clear difference in depth is an
  // occlusion.
  for (auto& patch : warped) {
    for (WarpedPixel& w : patch) {
      if (!w.visible) continue;
      const double front_m = cell(w);
      const double tolerance_m = std::max(3.0 * depth_sigma_m(front_m, depth), depth.edge_jump * front_m);
      w.visible = w.depth_m <= front_m + tolerance_m;
    }
  }
}

void test_measured_occlusion(std::span<WarpedPixel> warped, const DepthImage& depth_m, int scale,
                             double tolerance_m, const DepthConfig& depth) {
  for (WarpedPixel& w : warped) {
    if (!w.visible) continue;
    const int x = static_cast<int>(std::lround(w.pixel_px.x() * scale));
    const int y = static_cast<int>(std::lround(w.pixel_px.y() * scale));
    if (!depth_m.contains(x, y)) continue;
    const double measured_m = depth_m(x, y);
    if (measured_m <= 0) continue;  // no measurement, no verdict
    const double allowed_m = std::max(tolerance_m, 3.0 * depth_sigma_m(measured_m, depth));
    w.covered = w.depth_m - measured_m > allowed_m;
    w.visible = std::abs(w.depth_m - measured_m) <= allowed_m;
  }
}

bool is_extended(std::span<const WarpedPixel> warped, int size_px) {
  Eigen::AlignedBox2d box;
  for (const WarpedPixel& w : warped) {
    if (w.visible) box.extend(w.pixel_px);
  }
  // Pixel centres of the square span size - 1; a whole pixel more is an extension.
  return !box.isEmpty() && box.sizes().maxCoeff() >= size_px;
}

}  // namespace fusebench
