// Patches: small squares of the last frame, with intensity, and depth and normals from the model
// (Sec. 2.1.1, 2.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/patches/patch_surfaces.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::patches {

/// One pixel of a patch, P_i = (p_i, I_i, d_i, n_i) of the paper, already in the world as L_i (Eq. 1).
struct PatchPixel {
  Vector3d point_world = Vector3d::Zero();                 ///< model surface behind the pixel, metres
  Eigen::Vector3f normal_world = Eigen::Vector3f::Zero();  ///< unit, towards free space
  float intensity = 0;                                     ///< grey levels, at the patch level
  std::uint32_t reference_pixel =
      0;  ///< v * width + u of its place in the reference frame, level 0 coordinates
  /// The frame measured depth here as well, of one surface over the footprint of the pixel at its level, so
  /// that colour and depth belong together. At a silhouette a pixel of the near surface may have the depth of
  /// the far one, which would move it the wrong way: the colour of such pixels is not aligned by (it counts
  /// in the intensity error all the same).
  bool depth_confirmed = true;
};

/// What is projected in place of a pixel's own point to find it in the next frame: it lands at project(point)
/// + offset. This is all that the kinds of deformation differ in.
struct WarpPoint {
  Vector3d point_world = Vector3d::Zero();
  Vector2d offset_px = Vector2d::Zero();  ///< pixels of the patch level
};

/// The patch at one pyramid level: up to size x size pixels that have a model surface.
struct PatchLevel {
  std::vector<PatchPixel> pixels;
  std::vector<WarpPoint> warp_points;  ///< one each, or empty if pixels move by their own points
};

struct Patch {
  Eigen::Vector2i centre_px = Eigen::Vector2i::Zero();  ///< in the reference frame, level 0; the square spans
                                                        ///< [centre - size/2, centre + size/2)
  int age = 0;                                          ///< frames since its corner was detected
  std::vector<PatchLevel> levels;                       ///< fine to coarse
  /// Grey levels of the whole square at level 0, row by row, with or without a surface. The square is in the
  /// image.
  std::vector<std::uint8_t> square_grey;
};

/// The frame that patches are cut from.
struct ReferenceFrame {
  std::span<const GreyImage> pyramid;
  const DepthImage& depth_m;  ///< gated, unless patches.reference_surface is frame_ungated
  const PinholeCamera& camera;
  SE3 T_world_camera;
};

/// Position of a patch of the last frame in the current one.
struct TrackedCentre {
  Vector2d pixel_px = Vector2d::Zero();
  int age = 0;
};

/// The options by which patches are cut.
struct CutOptions {
  const config::PatchConfig& patches;
  const config::DepthConfig& depth;
  config::Deformation deformation;
};

/// Reusable buffers for cutting patches.
struct PatchWorkspace {
  std::vector<raycast::ExpectedSurface>
      pixels;                      ///< of level 0 that a patch needs at any level, by patch; depth 0 = none
  std::vector<std::size_t> first;  ///< of each patch, and the end
  std::vector<std::int32_t> pixel_of;           ///< by patch, level, row, column; -1 = none
  std::vector<raycast::SurfacePoint> measured;  ///< of the pixels, if patches take the frame's surface
  PatchSurfaces surfaces;
};

/// Sec. 2.3: surviving patches are cut again as squares at their new places, and FAST corners with enough
/// depth fill the image up to max_count, spread over a grid. Intensity comes from the frame, depth and
/// normals from the model (or from the frame: patches.reference_surface). The memory of `patches` is used
/// again.
void refresh_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                     std::span<const TrackedCentre> survivors, const CutOptions& options,
                     const Workers& workers, PatchWorkspace& work, std::vector<Patch>& patches);
/// The same into memory of its own.
[[nodiscard]] std::vector<Patch> refresh_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                                                 std::span<const TrackedCentre> survivors,
                                                 const CutOptions& options, const Workers& workers);

/// The mean share that a frame which was just fused has in the model where these patches are: near 1 where
/// the surface is new, small where many frames made it, 0 where the frame measured no depth and without
/// patches.
[[nodiscard]] double fused_share(const tsdf::TsdfVolume& model, std::span<const Patch> patches,
                                 const ReferenceFrame& frame, const config::DepthConfig& depth);

}  // namespace fusebench::patches
