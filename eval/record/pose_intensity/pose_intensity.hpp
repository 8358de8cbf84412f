// The intensity error of poses alone: one set of probe patches for all trajectories of a recording, cut and
// moved without any estimator, so that every system has a number, and the error of poses is apart from that
// of the patches that a system tracks.
//
// Definition. In each frame, squares of patches.size_px around FAST corners with depth (at most
// patches.max_count, as the estimator selects corners) are the probes; they depend on the images alone. A
// pixel p with depth d of frame k-1 goes to project(T_k^-1 T_{k-1} back_project(p, d)) in frame k by the
// poses of a trajectory, and its difference is |I_k(there) - I_{k-1}(p)|, bilinear, 8-bit grey. Which pixels
// count does not depend on the trajectory: where the true poses are known, those that they move into the
// image and onto what is measured there (so that nothing is occluded); else all. A pixel that a wrong pose
// moves out of the image is compared with the nearest pixel of the image. The error of a frame is the mean
// over its pixels, that of a trajectory the mean over the frames k of which all trajectories have both poses.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::pose_intensity {

struct NamedTrajectory {
  std::string name;
  Trajectory poses;  ///< T_world_camera at the stamps of colour images, in any world
};

struct TrajectoryIntensity {
  std::string name;
  double aie_grey = 0;     ///< mean absolute difference
  double rms_grey = 0;     ///< root of the mean over frames of the mean square
  std::size_t frames = 0;  ///< of which it has a pose, of all of the recording
};

struct PoseIntensity {
  std::vector<TrajectoryIntensity> trajectories;
  std::size_t frames = 0;    ///< that were compared
  std::size_t possible = 0;  ///< frames of the recording but the first
  std::size_t pixels = 0;
  bool visibility_by_truth = false;
  std::string depth;  ///< "true surface" or "measured"
};

struct ProbeOptions {
  bool true_depth = false;         ///< of the recording's true mesh, at the true poses
  double max_difference_s = 0.02;  ///< between the stamps of a frame and of a pose
};

/// Errors: data_missing (no frame has poses of all trajectories; true depth of a recording without a true
/// mesh), and those of the recording's images.
[[nodiscard]] Result<PoseIntensity> pose_intensity(const recording::Recording& recording,
                                                   std::span<const NamedTrajectory> trajectories,
                                                   const ProbeOptions& options);

}  // namespace fusebench::pose_intensity
