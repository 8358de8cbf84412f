// The model's surfaces behind the pixels of patches: beside what the camera measured, or along the rays where
// it measured nothing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/raycast.hpp"
#include "core/surface_search.hpp"
#include "core/tsdf_volume.hpp"
#include "core/types.hpp"

namespace fusebench {

/// Finds them, frame after frame in the same memory.
class PatchSurfaces {
 public:
  /// One surface a pixel, invalid where there is none; valid until the next call. `first`: number of the
  /// first pixel of each patch, and the end. A pixel whose depth_m is 0 has no measurement.
  [[nodiscard]] std::span<const SurfacePoint> find(const TsdfVolume& model, const PinholeCamera& camera,
                                                   const SE3& T_world_camera, const DepthConfig& depth,
                                                   std::span<const ExpectedSurface> pixels,
                                                   std::span<const std::size_t> first,
                                                   const Workers& workers);

 private:
  /// What some patches that are searched one after the other work in.
  struct Beside {
    TsdfBrick brick;
    std::vector<ExpectedSurface> measured;
    std::vector<std::size_t> places;
    std::vector<SurfacePoint> found;
  };

  void find_beside(const SurfaceSearch& search, std::span<const ExpectedSurface> pixels,
                   std::span<const std::size_t> first, const Workers& workers);
  void find_around(const SurfaceSearch& search, std::span<const ExpectedSurface> pixels,
                   const Workers& workers);
  void walk_rays(const TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                 const DepthConfig& depth, std::span<const ExpectedSurface> pixels, const Workers& workers);

  std::vector<SurfacePoint> surfaces_;
  std::vector<Beside> beside_;  // one a chunk of patches
  // Pixels that were not found at once:
  std::vector<std::size_t> places_;
  std::vector<ExpectedSurface> expected_;
  std::vector<PixelRay> rays_;
  std::vector<SurfacePoint> hits_;
};

}  // namespace fusebench
