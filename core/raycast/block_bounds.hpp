// Lower bounds on the depth at which the rays of a camera can meet the model.
#pragma once

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/simd/lanes.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::raycast {

/// For each tile of an image, the z-depth of the nearest block of a volume that any of its rays passes, so
/// that rays can skip the empty space before it. Conservative: blocks count as the spheres around them, with
/// what interpolation reaches beyond.
class BlockBounds {
 public:
  /// Numbers of tiles, both included.
  struct Range {
    int first;
    int last;

    [[nodiscard]] bool empty() const { return last < first; }
  };

  /// Blocks beyond depth.max_m do not count.
  BlockBounds(const tsdf::TsdfVolume& volume, const PinholeCamera& camera, const SE3& T_world_camera,
              const config::DepthConfig& depth);

  /// Metres; infinite where there are no blocks, 0 for pixels outside of the image.
  [[nodiscard]] simd::Float8 nearest_m(simd::Float8 u_px, simd::Float8 v_px) const;

 private:
  struct Sphere;
  /// Where a sphere may be seen, and how near it is (metres).
  struct Tiles {
    Range columns;
    Range rows;
    float near_m;
  };
  void add_region(const tsdf::TsdfVolume& volume, std::size_t region);
  [[nodiscard]] Tiles tiles_of(const Sphere& sphere) const;
  void add(const Tiles& tiles);

  PinholeCamera camera_;
  SE3 T_camera_world_;
  Matrix3d R_camera_world_;
  double voxel_m_;
  double min_m_, max_m_;
  Image<float> tiles_m_;
};

}  // namespace fusebench::raycast
