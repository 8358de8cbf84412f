// Whether patches are what they should be, and how many pixels they have, for the programs that measure the
// kernels that cut and pack them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/estimator/patches/patch_lanes.hpp"
#include "tests/bench/patch_problem.hpp"

namespace fusebench::testing {

/// Of all levels.
inline std::size_t pixels_of(std::span<const patches::Patch> patches) {
  std::size_t pixels = 0;
  for (const patches::Patch& patch : patches) {
    for (const patches::PatchLevel& level : patch.levels) pixels += level.pixels.size();
  }
  return pixels;
}

/// A pixel has the grey level of its place in its level, a point of the model behind that place, where depth
/// was measured if it was, and a normal that faces the camera.
inline bool is_cut_from(const patches::PatchPixel& pixel, std::size_t level,
                        const patches::ReferenceFrame& frame) {
  constexpr double kSameSurface_m = 0.15;
  const auto width = static_cast<std::uint32_t>(frame.camera.width_px);
  const auto u = static_cast<int>(pixel.reference_pixel % width);
  const auto v = static_cast<int>(pixel.reference_pixel / width);
  const Vector3d point = frame.T_world_camera.inverse() * pixel.point_world;
  const Vector3d normal =
      frame.T_world_camera.rotation.conjugate() * Vector3d(pixel.normal_world.cast<double>());
  const double measured_m = static_cast<double>(frame.depth_m(u, v));
  const bool same_surface = measured_m <= 0 || std::abs(point.z() - measured_m) < kSameSurface_m;
  return std::abs(pixel.intensity - frame.pyramid[level](u >> level, v >> level)) < 1e-6 && same_surface &&
         (frame.camera.project(point) - Vector2d(u, v)).norm() < 1e-3 && std::abs(normal.norm() - 1) < 1e-4 &&
         normal.dot(point) < 0;
}

/// Many patches, each with pixels at every level that are cut from the frame.
inline bool are_cut_from(std::span<const patches::Patch> patches, const patches::ReferenceFrame& frame) {
  for (const patches::Patch& patch : patches) {
    if (patch.levels.size() != frame.pyramid.size() || patch.levels[0].pixels.empty()) return false;
    for (std::size_t level = 0; level < patch.levels.size(); ++level) {
      for (const patches::PatchPixel& pixel : patch.levels[level].pixels) {
        if (!is_cut_from(pixel, level, frame)) return false;
      }
    }
  }
  return patches.size() > 20;
}

/// The lanes of a level hold its pixels, patch after patch.
inline bool are_packed(const patches::LevelLanes& lanes, std::span<const patches::Patch> patches,
                       std::size_t level, const Vector3d& origin_world) {
  const auto lane_of = [](const simd::Points& points, std::size_t lane) {
    return Vector3d(points.x[lane], points.y[lane], points.z[lane]);
  };
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const std::vector<patches::PatchPixel>& pixels = patches[p].levels[level].pixels;
    const std::span<const patches::PixelLanes> packed = lanes.pixels_of(p);
    if (packed.size() != (pixels.size() + simd::kLanes - 1) / simd::kLanes) return false;
    for (std::size_t i = 0; i < packed.size() * simd::kLanes; ++i) {
      const patches::PixelLanes& eight = packed[i / simd::kLanes];
      const std::size_t lane = i % simd::kLanes;
      if ((eight.present[lane] != 0) != (i < pixels.size())) return false;
      if (i >= pixels.size()) continue;
      const Vector3d point = pixels[i].point_world - origin_world;
      const Vector3d normal = pixels[i].normal_world.cast<double>();
      if ((lane_of(eight.point, lane) - point).norm() > 1e-6 ||
          (lane_of(eight.normal, lane) - normal).norm() > 1e-6 ||
          std::abs(static_cast<double>(eight.intensity[lane]) - pixels[i].intensity) > 1e-3)
        return false;
    }
  }
  return true;
}

/// Pixels of all levels: those of patches, and with a residual of each kind.
struct ResidualCounts {
  std::size_t pixels = 0;
  std::size_t photometric = 0;
  std::size_t geometric = 0;
};
/// At the last linearisation. accepted: only of patches that count in trials.
inline ResidualCounts residual_counts(const measurement::PatchMeasurement& measurement,
                                      std::span<const patches::Patch> patches, bool accepted) {
  ResidualCounts counts;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const measurement::PatchOutcome& outcome = measurement.outcomes()[p];
    if (accepted && !outcome.accepted) continue;
    counts.pixels += pixels_of(patches.subspan(p, 1));
    counts.photometric += static_cast<std::size_t>(outcome.photometric_residuals);
    counts.geometric += static_cast<std::size_t>(outcome.geometric_residuals);
  }
  return counts;
}

}  // namespace fusebench::testing
