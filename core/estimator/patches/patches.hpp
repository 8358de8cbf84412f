// Patches: small squares of their anchor, with intensity, and depth and normals from the model
// (Sec. 2.1.1, 2.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/patches/patch_surfaces.hpp"

namespace fusebench::patches {

/// One pixel of a patch, P_i = (p_i, I_i, d_i, n_i) of the paper, as the world point L_i (Eq. 1).
struct PatchPixel {
  Vector3d point_world = Vector3d::Zero();                 ///< model surface at the pixel, metres
  Eigen::Vector3f normal_world = Eigen::Vector3f::Zero();  ///< unit, towards free space
  float intensity = 0;                                     ///< grey levels, at the patch level
  std::uint32_t reference_pixel = 0;  ///< v * width + u in the reference frame, level-0 coordinates
  /// True if the frame measured the depth of a single surface over the footprint of the pixel, so that colour
  /// and depth belong together. At a silhouette, a pixel of the near surface may have the depth of the far
  /// one and would move wrongly. Such pixels are not used for alignment, but count in the intensity error.
  bool depth_confirmed = true;
};

/// Point that is projected instead of the surface point of a pixel: position = project(point) + offset. The
/// kinds of deformation differ in this only.
struct WarpPoint {
  Vector3d point_world = Vector3d::Zero();
  Vector2d offset_px = Vector2d::Zero();  ///< pixels of the patch level
};

/// A patch at one pyramid level: up to size x size pixels with a model surface.
struct PatchLevel {
  std::vector<PatchPixel> pixels;
  std::vector<WarpPoint> warp_points;  ///< one each; empty if pixels use their own points
};

struct Patch {
  /// in the reference frame, level 0; square: [centre - size/2, centre + size/2)
  Eigen::Vector2i centre_px = Eigen::Vector2i::Zero();
  int age = 0;                     ///< frames since the detection of its corner
  std::vector<PatchLevel> levels;  ///< fine to coarse
  /// Grey levels of the whole square at level 0, by rows, with or without a surface. The square is inside the
  /// image.
  std::vector<std::uint8_t> square_grey;
};

/// The frame from which patches are cut.
struct ReferenceFrame {
  std::span<const GreyImage> pyramid;
  const DepthImage& depth_m;  ///< gated, unless patches.reference_surface is frame_ungated
  const PinholeCamera& camera;
  SE3 T_world_camera;
};

/// Position of a patch in the current frame.
struct TrackedCentre {
  Vector2d pixel_px = Vector2d::Zero();
  int age = 0;
};

/// Options for cutting patches.
struct CutOptions {
  const config::PatchConfig& patches;
  const config::DepthConfig& depth;
  config::Deformation deformation;
};

/// Reusable buffers for cutting patches.
struct PatchWorkspace {
  std::vector<raycast::ExpectedSurface>
      pixels;                          ///< level-0 pixels that a patch needs, by patch; depth 0 = none
  std::vector<std::size_t> first;      ///< index of the first pixel of each patch, and the end
  std::vector<std::int32_t> pixel_of;  ///< by patch, level, row, column; -1 = none
  std::vector<raycast::SurfacePoint> measured;  ///< measured surfaces of the pixels, if patches use them
  PatchSurfaces surfaces;
};

/// Sec. 2.3: cuts surviving patches again as squares at their new positions, and adds FAST corners with
/// enough depth up to max_count, distributed over a grid. Intensity is from the frame, depth and normals from
/// the model (or the frame: patches.reference_surface). Reuses the memory of `patches`.
void refresh_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                     std::span<const TrackedCentre> survivors, const CutOptions& options,
                     const Workers& workers, PatchWorkspace& work, std::vector<Patch>& patches);
/// Variant that returns new patches.
[[nodiscard]] std::vector<Patch> refresh_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                                                 std::span<const TrackedCentre> survivors,
                                                 const CutOptions& options, const Workers& workers);

/// Mean share of a just fused frame in the model at the pixels of these patches: near 1 for a new surface,
/// small for a surface of many frames, 0 where the frame has no depth. 0 without patches.
[[nodiscard]] double fused_share(const tsdf::TsdfVolume& model, std::span<const Patch> patches,
                                 const ReferenceFrame& frame, const config::DepthConfig& depth);

}  // namespace fusebench::patches
