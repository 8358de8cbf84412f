#include "eval/record/pose_intensity/pose_intensity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/image.hpp"
#include "core/base/mesh/ply_file.hpp"
#include "core/base/trajectory/association.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"
#include "eval/record/pose_intensity/probes.hpp"
#include "eval/record/record_origin.hpp"

namespace fusebench::pose_intensity {

namespace {

// Every system is probed at the same places, so these are the defaults.
constexpr config::PatchConfig kProbePatches{};
constexpr config::DepthConfig kProbeDepth{};

/// The pose of each frame, where the trajectory has one.
std::vector<std::optional<SE3>> poses_of_frames(const recording::Recording& recording,
                                                const Trajectory& trajectory, double max_difference_s) {
  std::vector<std::int64_t> frames_ns, poses_ns;
  for (const recording::FrameEntry& frame : recording.frames) frames_ns.push_back(frame.timestamp_ns);
  for (const StampedPose& pose : trajectory) poses_ns.push_back(pose.timestamp_ns);
  std::vector<std::optional<SE3>> poses(recording.frames.size());
  for (const trajectory::AssociatedPair& pair :
       trajectory::associate(frames_ns, poses_ns, std::llround(1e9 * max_difference_s)))
    poses[pair.first] = trajectory[pair.second].T_world_camera;
  return poses;
}

/// What of a frame is compared with the next one.
struct ProbedFrame {
  GreyImage grey;
  DepthImage depth_m;  ///< gated
  std::optional<SE3> T_truth_camera;
};

/// Loads frames, and the true surface if that is requested.
class FrameLoader {
 public:
  explicit FrameLoader(const recording::Recording& recording) : recording_(recording) {}

  Result<void> load_surface() {
    if (recording_.truth_mesh_file.empty() || recording_.ground_truth.empty())
      return fail(ErrorCode::data_missing,
                  "--true-depth requires a recording with a ground-truth mesh and ground-truth poses",
                  "simulated recordings have both; without this option the measured depth is used");
    const auto mesh = mesh::read_ply(recording_.truth_mesh_file);
    if (!mesh) return tl::unexpected(mesh.error());
    surface_.emplace(mesh->cast<float>());
    return {};
  }

  [[nodiscard]] Result<ProbedFrame> load(std::size_t number) const {
    auto frame = recording_.load_frame(number);
    if (!frame) return tl::unexpected(frame.error());
    ProbedFrame probed{std::move(frame->grey), {}, {}};
    preprocessing::gate_depth(frame->depth_m, kProbeDepth, probed.depth_m);
    probed.T_truth_camera = record::true_camera(recording_, recording_.frames[number].capture_ns);
    return probed;
  }

  [[nodiscard]] std::vector<Probe> probes(const ProbedFrame& frame) const {
    const PinholeCamera& camera = recording_.rig.camera;
    if (!surface_) return probes_of(frame.grey, frame.depth_m, camera, kProbePatches, nullptr);
    if (!frame.T_truth_camera) return {};
    const DepthImage depth_m = true_depth_m(*surface_, camera, *frame.T_truth_camera);
    return probes_of(frame.grey, frame.depth_m, camera, kProbePatches, &depth_m);
  }

 private:
  const recording::Recording& recording_;
  std::optional<simulator::rays::RayCaster> surface_;
};

/// Leaves the probes that are seen in the next frame, by the true poses.
void keep_seen(std::vector<Probe>& probes, const SE3& T_now_before, const ProbedFrame& now,
               const PinholeCamera& camera) {
  std::erase_if(probes, [&](const Probe& probe) {
    return !is_seen(T_now_before * probe.point_camera, camera, now.depth_m, kProbePatches, kProbeDepth);
  });
}

/// Sums over frames of the mean absolute and the mean squared difference.
struct Sums {
  double absolute = 0;
  double squared = 0;

  void add_frame(const std::vector<Probe>& probes, const GreyImage& now, const PinholeCamera& camera,
                 const SE3& T_now_before) {
    double sum = 0, squares = 0;
    for (const Probe& probe : probes) {
      const Vector2d at = landed_px(camera, T_now_before, probe.point_camera);
      // Written so that what is not a number is at the border, too.
      const double x = std::min(std::max(0.0, at.x()), static_cast<double>(now.width - 1));
      const double y = std::min(std::max(0.0, at.y()), static_cast<double>(now.height - 1));
      const double difference = std::abs(sample_bilinear(now, x, y).value - probe.grey);
      sum += difference;
      squares += difference * difference;
    }
    absolute += sum / static_cast<double>(probes.size());
    squared += squares / static_cast<double>(probes.size());
  }
};

}  // namespace

Result<PoseIntensity> pose_intensity(const recording::Recording& recording,
                                     std::span<const NamedTrajectory> trajectories,
                                     const ProbeOptions& options) {
  FrameLoader loader(recording);
  if (options.true_depth) {
    if (auto loaded = loader.load_surface(); !loaded) return tl::unexpected(loaded.error());
  }
  std::vector<std::vector<std::optional<SE3>>> poses;
  for (const NamedTrajectory& trajectory : trajectories)
    poses.push_back(poses_of_frames(recording, trajectory.poses, options.max_difference_s));
  PoseIntensity result;
  result.possible = recording.frames.empty() ? 0 : recording.frames.size() - 1;
  result.depth = options.true_depth ? "true surface" : "measured";
  std::vector<Sums> sums(trajectories.size());
  std::optional<ProbedFrame> before;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    auto now = loader.load(k);
    if (!now) return tl::unexpected(now.error());
    const bool all = before && std::ranges::all_of(poses, [&](const auto& of) { return of[k - 1] && of[k]; });
    std::vector<Probe> probes = all ? loader.probes(*before) : std::vector<Probe>{};
    if (all && before->T_truth_camera && now->T_truth_camera) {
      result.visibility_by_truth = true;
      keep_seen(probes, now->T_truth_camera->inverse() * *before->T_truth_camera, *now, recording.rig.camera);
    }
    if (!probes.empty()) {
      ++result.frames;
      result.pixels += probes.size();
      for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i].add_frame(probes, now->grey, recording.rig.camera, poses[i][k]->inverse() * *poses[i][k - 1]);
    }
    before = std::move(*now);
  }
  if (result.frames == 0)
    return fail(ErrorCode::data_missing,
                fmt::format("no two frames in a row have poses of all {} trajectories", trajectories.size()),
                "poses belong to the colour image whose stamp is within 0.02 s");
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto frames = static_cast<double>(result.frames);
    const auto has_pose = [](const std::optional<SE3>& pose) { return pose.has_value(); };
    result.trajectories.push_back({trajectories[i].name, sums[i].absolute / frames,
                                   std::sqrt(sums[i].squared / frames),
                                   static_cast<std::size_t>(std::ranges::count_if(poses[i], has_pose))});
  }
  return result;
}

}  // namespace fusebench::pose_intensity
