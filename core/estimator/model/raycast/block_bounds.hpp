// Lower bounds of the depth at which the rays of a camera can meet the model.
#pragma once

#include "core/base/image.hpp"
#include "core/base/simd/lanes.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::raycast {

/// For each image tile, the z-depth of the nearest block that any of its rays passes, so that rays can skip
/// the empty space before it. Conservative: uses the bounding spheres of the blocks, enlarged by the reach of
/// interpolation.
class BlockBounds {
 public:
  /// Range of tile indices, inclusive.
  struct Range {
    int first;
    int last;

    [[nodiscard]] bool empty() const { return last < first; }
  };

  /// Ignores blocks beyond depth.max_m.
  BlockBounds(const tsdf::TsdfVolume& volume, const PinholeCamera& camera, const SE3& T_world_camera,
              const config::DepthConfig& depth);

  /// Metres; infinite without blocks, 0 for pixels outside the image.
  [[nodiscard]] simd::Float8 nearest_m(simd::Float8 u_px, simd::Float8 v_px) const;

 private:
  struct Sphere;
  /// Tiles that a sphere may cover, and its smallest depth (metres).
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
