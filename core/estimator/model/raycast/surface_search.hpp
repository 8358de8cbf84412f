// Finds the model's surface near a measured one: a few steps from the measurement to the nearest zero of the
// field, instead of marching along the ray.
#pragma once

#include <cstddef>
#include <span>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/raycast/ray_lanes.hpp"
#include "core/estimator/model/tsdf/tsdf_brick.hpp"
#include "core/estimator/model/tsdf/tsdf_lanes.hpp"
#include "core/estimator/preprocessing/depth_sigma.hpp"

namespace fusebench::raycast {

/// A pixel and the expected depth of its surface.
struct ExpectedSurface {
  float u_px = 0;
  float v_px = 0;
  float depth_m = 0;
  float reach_m = 0;  ///< largest distance from the expected depth
};

class SurfaceSearch {
 public:
  /// field: in view of that camera (field_in_view); must outlive the search.
  SurfaceSearch(const tsdf::TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                const config::DepthConfig& depth);

  /// Follows the field from the expected position to a zero of the trilinear field, to a fiftieth of a voxel,
  /// and computes the normal. Invalid if there is no zero within reach or the search leaves observed space;
  /// then use raycast_pixels().
  void find(std::span<const ExpectedSurface> pixels, std::span<SurfacePoint> surfaces) const;

  /// Variant for pixels that are close together in image and depth, with an error of the expected depth
  /// within the noise. `brick`: workspace.
  void find_near_measurements(std::span<const ExpectedSurface> pixels, tsdf::TsdfBrick& brick,
                              std::span<SurfacePoint> surfaces) const;

 private:
  struct Box;
  struct PixelGroup;

  template <class Field>
  void find_in(const Field& field, const Vector3d& field_origin_voxel, bool beside,
               std::span<const ExpectedSurface> pixels, std::span<SurfacePoint> surfaces) const;
  template <class Field>
  [[nodiscard]] Hits search(const PixelGroup& group, const Eigen::Vector3f& origin, const Field& field) const;
  [[nodiscard]] PixelGroup group_of(std::span<const ExpectedSurface> pixels, std::size_t begin,
                                    bool beside) const;
  [[nodiscard]] Box box_around(std::span<const ExpectedSurface> pixels) const;

  const tsdf::TsdfLanes& field_;
  PixelRays rays_;
  Vector3d camera_voxel_;
  preprocessing::DepthSigma depth_sigma_;
  float nearest_m_, farthest_m_;
  float voxel_m_;
};

}  // namespace fusebench::raycast
