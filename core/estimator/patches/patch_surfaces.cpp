#include "core/estimator/patches/patch_surfaces.hpp"

#include <algorithm>
#include <optional>

#include "core/base/error.hpp"

namespace fusebench::patches {

namespace {

constexpr std::size_t kPatchesPerWorkspace = 8;
constexpr std::size_t kPixelsPerChunk = 512;

}  // namespace

std::span<const raycast::SurfacePoint> PatchSurfaces::find(
    const tsdf::TsdfVolume& model, const PinholeCamera& camera, const SE3& T_world_camera,
    const config::DepthConfig& depth, std::span<const raycast::ExpectedSurface> pixels,
    std::span<const std::size_t> first, const Workers& workers) {
  check(!first.empty() && first.back() == pixels.size(), "patches have all pixels");
  surfaces_.assign(pixels.size(), raycast::SurfacePoint{});
  const std::optional<tsdf::TsdfLanes> field = tsdf::field_in_view(model, camera, T_world_camera, depth);
  if (!field) return surfaces_;
  const raycast::SurfaceSearch search(*field, camera, T_world_camera, depth);
  find_near_measurements(search, pixels, first, workers);
  find_around(search, pixels, workers);
  walk_rays(*field, camera, T_world_camera, depth, pixels, workers);
  return surfaces_;
}

/// Local search near the measured depth, parallel over patches.
void PatchSurfaces::find_near_measurements(const raycast::SurfaceSearch& search,
                                           std::span<const raycast::ExpectedSurface> pixels,
                                           std::span<const std::size_t> first, const Workers& workers) {
  const std::size_t patches = first.size() - 1;
  workspaces_.resize(std::max(workspaces_.size(), patches / kPatchesPerWorkspace + 1));
  workers.for_chunks(patches, kPatchesPerWorkspace, [&](std::size_t begin, std::size_t end) {
    auto& [brick, measured, places, found] = workspaces_[begin / kPatchesPerWorkspace];
    for (std::size_t p = begin; p < end; ++p) {
      measured.clear();
      places.clear();
      for (std::size_t i = first[p]; i < first[p + 1]; ++i) {
        if (pixels[i].depth_m <= 0) continue;
        measured.push_back(pixels[i]);
        places.push_back(i);
      }
      found.resize(measured.size());
      search.find_near_measurements(measured, brick, found);
      for (std::size_t i = 0; i < places.size(); ++i) surfaces_[places[i]] = found[i];
    }
  });
}

/// Wider search for pixels without a result.
void PatchSurfaces::find_around(const raycast::SurfaceSearch& search,
                                std::span<const raycast::ExpectedSurface> pixels, const Workers& workers) {
  expected_.clear();
  places_.clear();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (surfaces_[i].valid || pixels[i].depth_m <= 0) continue;
    expected_.push_back(pixels[i]);
    places_.push_back(i);
  }
  hits_.resize(places_.size());
  workers.for_chunks(places_.size(), kPixelsPerChunk, [&](std::size_t begin, std::size_t end) {
    search.find(std::span(expected_).subspan(begin, end - begin),
                std::span(hits_).subspan(begin, end - begin));
  });
  for (std::size_t i = 0; i < places_.size(); ++i) surfaces_[places_[i]] = hits_[i];
}

/// Ray casting around the measured depth, or along the whole ray without one.
void PatchSurfaces::walk_rays(const tsdf::TsdfLanes& field, const PinholeCamera& camera,
                              const SE3& T_world_camera, const config::DepthConfig& depth,
                              std::span<const raycast::ExpectedSurface> pixels, const Workers& workers) {
  rays_.clear();
  places_.clear();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (surfaces_[i].valid) continue;
    const raycast::ExpectedSurface& pixel = pixels[i];
    raycast::PixelRay& ray = rays_.emplace_back();
    ray.u_px = static_cast<double>(pixel.u_px);
    ray.v_px = static_cast<double>(pixel.v_px);
    if (pixel.depth_m > 0) {
      ray.begin_m = pixel.depth_m - pixel.reach_m;
      ray.end_m = pixel.depth_m + pixel.reach_m;
    }
    places_.push_back(i);
  }
  if (rays_.empty()) return;
  raycast::raycast_pixels(field, camera, T_world_camera, rays_, depth, workers, hits_);
  for (std::size_t i = 0; i < places_.size(); ++i) surfaces_[places_[i]] = hits_[i];
}

}  // namespace fusebench::patches
