// Which pose of another system belongs to which frame of a recording.
#pragma once

#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/record/record_origin.hpp"

namespace fusebench::external {

/// The poses that belong to a frame, with the instants that they are of.
struct FramePoses {
  Trajectory poses;
  std::vector<record::StampAndInstant> stamps;
};

/// A pose belongs to the frame whose stamp is nearest, within 0.02 s. Poses without stamps (kitti) must be as
/// many as the frames; those with numbers (log) say which frames they are of. Error data_corrupt: poses that
/// belong to no frame.
[[nodiscard]] Result<FramePoses> poses_of_frames(trajectory_files::LoadedTrajectory loaded,
                                                 const recording::Recording& recording);

}  // namespace fusebench::external
