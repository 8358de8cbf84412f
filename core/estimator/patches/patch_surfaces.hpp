// Model surfaces at the pixels of patches: near the measured depth, or along the whole ray without a
// measurement.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/raycast/raycast.hpp"
#include "core/estimator/model/raycast/surface_search.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::patches {

/// Searches the surfaces; the buffers are reused.
class PatchSurfaces {
 public:
  /// One surface for each pixel, invalid if none was found; valid until the next call. `first`: index of the
  /// first pixel of each patch, and the end. depth_m = 0: no measurement.
  [[nodiscard]] std::span<const raycast::SurfacePoint> find(
      const tsdf::TsdfVolume& model, const PinholeCamera& camera, const SE3& T_world_camera,
      const config::DepthConfig& depth, std::span<const raycast::ExpectedSurface> pixels,
      std::span<const std::size_t> first, const Workers& workers);

 private:
  /// Workspace of one chunk of patches.
  struct Workspace {
    tsdf::TsdfBrick brick;
    std::vector<raycast::ExpectedSurface> measured;
    std::vector<std::size_t> places;
    std::vector<raycast::SurfacePoint> found;
  };

  void find_near_measurements(const raycast::SurfaceSearch& search,
                              std::span<const raycast::ExpectedSurface> pixels,
                              std::span<const std::size_t> first, const Workers& workers);
  void find_around(const raycast::SurfaceSearch& search, std::span<const raycast::ExpectedSurface> pixels,
                   const Workers& workers);
  void walk_rays(const tsdf::TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                 const config::DepthConfig& depth, std::span<const raycast::ExpectedSurface> pixels,
                 const Workers& workers);

  std::vector<raycast::SurfacePoint> surfaces_;
  std::vector<Workspace> workspaces_;  // one for each chunk of patches
  // Pixels that the local search did not find:
  std::vector<std::size_t> places_;
  std::vector<raycast::ExpectedSurface> expected_;
  std::vector<raycast::PixelRay> rays_;
  std::vector<raycast::SurfacePoint> hits_;
};

}  // namespace fusebench::patches
