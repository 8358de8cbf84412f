// BundleFusion's method on the CPU (Dai et al., "BundleFusion: Real-Time Globally Consistent 3D
// Reconstruction Using On-the-Fly Surface Reintegration", 2017). Keypoints and depth of ten frames form a
// chunk, chunks are matched with all others, and all poses are optimised together.
//
// There is neither a motion model nor tracking against the model: a frame without matches is lost. Frames are
// fused once, at their final poses, instead of reintegrating the surface after each change.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/replay.hpp"
#include "core/baselines/bundlefusion/chunk.hpp"
#include "core/baselines/bundlefusion/keyframe_graph.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "core/system/system.hpp"

namespace fusebench::baselines::bundlefusion {

class BundlefusionSystem final : public system::System {
 public:
  /// workers must outlive the system. OpenCV is limited to the same number of threads. replay: required for
  /// revise().
  BundlefusionSystem(const config::BundlefusionConfig& config, const config::DepthConfig& depth,
                     const config::TsdfConfig& tsdf, const SensorRig& rig, const Workers& workers,
                     Replay replay);

  /// The world is the camera frame of the first frame with keypoints. The pose is T_world_chunk (all earlier
  /// chunks) times the pose in the chunk (frames so far).
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  /// Final poses of the frames whose chunk has a pose; these frames are fused. Nothing if there are none.
  /// Errors: run_failed (a full model), those of the replay.
  [[nodiscard]] Result<std::optional<Trajectory>> revise() override;
  /// The surface fused by revise().
  [[nodiscard]] system::Surface take_surface() override;

 private:
  /// Position of a frame in a chunk; a frame shared by two chunks has two.
  struct Membership {
    std::size_t chunk = 0;
    std::size_t place = 0;
  };
  struct KnownFrame {
    std::int64_t timestamp_ns = 0;
    std::vector<Membership> memberships;  ///< empty before the first frame with keypoints
  };
  struct ClosedChunk {
    Poses T_first_camera;
    std::optional<std::size_t> keyframe;  ///< index in the graph; nothing if the chunk is inconsistent
  };

  [[nodiscard]] View view_of(const RgbdFrame& frame);
  std::optional<SE3> begin(View view);
  std::optional<SE3> follow(View view);
  void start_chunk(View first, std::size_t frame);
  void close_chunk();
  void start_next_chunk();
  [[nodiscard]] std::optional<SE3> T_world_chunk(std::size_t chunk) const;
  [[nodiscard]] std::optional<SE3> final_pose(const KnownFrame& frame) const;
  [[nodiscard]] Result<void> fuse(const RgbdFrame& frame, const Trajectory& final_trajectory);

  config::BundlefusionConfig config_;
  config::DepthConfig depth_;
  config::DepthConfig keypoint_depth_;
  PinholeCamera camera_;
  const Workers& workers_;
  KeyframeGraph graph_;
  tsdf::TsdfVolume model_;
  std::vector<KnownFrame> frames_;
  std::vector<ClosedChunk> chunks_;
  std::optional<Chunk> chunk_;                ///< chunk under construction
  std::vector<std::size_t> frames_of_chunk_;  ///< indices of its frames
  std::optional<SE3> T_world_first_;          ///< of its first frame; nothing if unknown
  SE3 T_world_start_;                         ///< of the first frame with enough keypoints
  SE3 T_world_camera_;                        ///< of the last frame that was not lost
  bool was_lost_ = false;
  Replay replay_;
  DepthImage gated_m_;
};

}  // namespace fusebench::baselines::bundlefusion
