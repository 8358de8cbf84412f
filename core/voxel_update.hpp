// One frame as the voxels of the model see it.
#pragma once

#include "core/lanes.hpp"
#include "core/tsdf_volume.hpp"

namespace fusebench {

/// What TsdfVolume::integrate does to the voxels of one block after the other. Single precision: an error of
/// 1e-7 of the depth is far below the depth noise. The frame must outlive it.
class VoxelUpdate {
 public:
  VoxelUpdate(const RgbdFrame& frame, const PinholeCamera& camera, const SE3& T_world_camera,
              const DepthConfig& depth, const TsdfConfig& tsdf);

  void apply(const BlockIndex& index, VoxelBlock& block) const;

 private:
  void observe_row(Float8 x_m, Float8 y_m, Float8 z_m, Voxel* row) const;
  void fuse_row(Float8 distance_m, Float8 weight, Int8 observed, Voxel* row) const;
  [[nodiscard]] Float8 sigma_m(Float8 depth_m) const;
  void add_color(const Rgb& observed, Voxel& voxel) const;

  const RgbdFrame& frame_;
  const DepthConfig& depth_;
  SE3 T_camera_world_;
  double voxel_m_;
  Eigen::Matrix3f step_camera_;  // columns: one voxel along each axis of the
                                 // world, in the camera frame
  float fx_, fy_, cx_, cy_;      // pixels
  float truncation_m_;
  float truncation_sigmas_;
  float voxel_variance_;  // m^2
  float max_weight_;
  float max_color_count_;
};

}  // namespace fusebench
