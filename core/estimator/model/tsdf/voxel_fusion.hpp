// Projection of one frame onto the voxels of the model.
#pragma once

#include "core/base/simd/lanes.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/preprocessing/depth_sigma.hpp"

namespace fusebench::tsdf {

/// Applies the update of TsdfVolume::integrate to blocks. Single precision: its error of 1e-7 of the depth is
/// far below the depth noise. The frame must outlive the object.
class VoxelUpdate {
 public:
  /// frame_number: number of frames fused so far; determines the rounding of colours.
  VoxelUpdate(const RgbdFrame& frame, const PinholeCamera& camera, const SE3& T_world_camera,
              const config::DepthConfig& depth, const config::TsdfConfig& tsdf, std::uint32_t frame_number);

  void apply(const BlockIndex& index, const BlockVoxels& block) const;

 private:
  /// Measurements of the frame for a row of eight voxels.
  struct SeenRow {
    simd::Int8 pixel;         ///< index; 0 outside the image
    simd::Float8 measured_m;  ///< depth at the pixel
    simd::Float8 distance_m;  ///< measured_m minus the depth of the voxel
    simd::Int8 seen;          ///< has a measurement and is not occluded by it
  };
  [[nodiscard]] SeenRow look(simd::Float8 x_m, simd::Float8 y_m, simd::Float8 z_m) const;
  [[nodiscard]] simd::Float8 band_m(simd::Float8 sigma_m) const;
  [[nodiscard]] simd::Int8 add_distance(const SeenRow& seen, const BlockVoxels& block, std::size_t row) const;
  void add_color(simd::Int8 pixel, simd::Int8 colored, const BlockVoxels& block, std::size_t row) const;

  const RgbdFrame& frame_;
  SE3 T_camera_world_;
  double voxel_m_;
  Eigen::Matrix3f step_camera_;  // columns: step of one voxel along each world axis, in the camera frame
  float fx_, fy_, cx_, cy_;      // pixels
  float nearest_m_, farthest_m_;
  preprocessing::DepthSigma depth_sigma_;
  float truncation_m_;
  float truncation_sigmas_;
  float voxel_variance_;  // m^2
  float max_weight_;
  float max_color_count_;
  float color_rounding_;  // added before truncation
};

}  // namespace fusebench::tsdf
