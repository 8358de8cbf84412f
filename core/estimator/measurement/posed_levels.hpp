// A pose hypothesis for the measurement of all patches.
#pragma once

#include <vector>

#include "core/estimator/measurement/patch_measurement.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::measurement {

/// Patches per task: fixed, so the chunks do not depend on the number of threads.
inline constexpr std::size_t kPatchesPerChunk = 8;

struct PatchMeasurement::PosedLevels {
  PosedLevels(const SensorRig& rig, const filter::PoseHypothesis& poses, int levels,
              const Vector3d& origin_world)
      : by_model(patches::PosedCamera(rig.camera, poses.T_world_imu_by_model, rig.T_imu_camera),
                 origin_world) {
    for (int level = 0; level < levels; ++level) {
      at.emplace_back(patches::PosedCamera(patches::camera_at_level(rig.camera, level),
                                           poses.T_world_imu_by_reference, rig.T_imu_camera),
                      origin_world);
    }
  }
  std::vector<patches::PosedLanes> at;  ///< relative to the reference frame
  patches::PosedLanes by_model;
};

}  // namespace fusebench::measurement
