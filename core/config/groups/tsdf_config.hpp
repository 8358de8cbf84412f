// Options: the model that depth is fused into.
#pragma once

namespace fusebench::config {

/// The model that depth is fused into.
struct TsdfConfig {
  double voxel_m = 0.01;
  double truncation_m = 0.04;
  double truncation_sigmas = 3.0;
  double max_weight = 64.0;
  int max_blocks = 400000;
  double min_mesh_weight = 2.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("voxel_m", self.voxel_m, 0.001, 1.0, "side of a voxel (metres)");
    v.number("truncation_m", self.truncation_m, 0.002, 5.0,
             "the signed distance is kept within this band (metres); at least two voxels");
    v.number("truncation_sigmas", self.truncation_sigmas, 0.0, 20.0,
             "the band grows with depth to this many standard deviations of the depth noise");
    v.number("max_weight", self.max_weight, 1.0, 2048.0,
             "largest weight of a voxel; a limit lets the model follow changes of the scene");
    v.number("max_blocks", self.max_blocks, 1, 4194303,
             "memory limit: blocks of 8x8x8 voxels; when it is reached the run reports it");
    v.number("min_mesh_weight", self.min_mesh_weight, 0.0, 2048.0,
             "voxels seen less than this are not meshed");
  }
};

}  // namespace fusebench::config
