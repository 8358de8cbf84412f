// BundleFusion's method on the processor (Dai et al., "BundleFusion: Real-Time Globally Consistent 3D
// Reconstruction Using On-the-Fly Surface Reintegration", 2017): keypoints and depth of ten frames make a
// chunk, chunks are matched with all others, and all poses are adjusted together.
//
// There is no motion model and no tracking against the model: a frame that matches nothing is lost. Instead
// of reintegrating the surface whenever poses change, frames are fused once, at their final poses.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/replay.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "core/systems/bundlefusion/chunk.hpp"
#include "core/systems/bundlefusion/keyframe_graph.hpp"
#include "core/systems/system.hpp"

namespace fusebench::systems::bundlefusion {

class BundlefusionSystem final : public System {
 public:
  /// workers must outlive it. The threads of OpenCV are limited to as many. replay: needed for revise().
  BundlefusionSystem(const config::BundlefusionConfig& config, const config::DepthConfig& depth,
                     const config::TsdfConfig& tsdf, const SensorRig& rig, const Workers& workers,
                     Replay replay);

  /// The world is the camera of the first frame that has keypoints. The pose is that of the chunk's first
  /// frame by all chunks before, times that within the chunk by the frames so far.
  [[nodiscard]] Result<health::FrameOutcome> process(const RgbdFrame& frame) override;
  /// Poses after the last adjustment, of the frames whose chunk has a place, which are fused; nothing if
  /// there are none. Errors: run_failed (a full model), those of the replay.
  [[nodiscard]] Result<std::optional<Trajectory>> revise() override;
  /// What revise() has fused.
  [[nodiscard]] Surface take_surface() override;

 private:
  /// A frame's place in a chunk; a frame that two chunks share has two.
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
    std::optional<std::size_t> keyframe;  ///< in the graph; nothing if the chunk contradicts itself
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
  std::optional<Chunk> chunk_;                ///< the one that frames are added to
  std::vector<std::size_t> frames_of_chunk_;  ///< indices of its frames
  std::optional<SE3> T_world_first_;          ///< of its first frame; nothing if that is not known
  SE3 T_world_start_;                         ///< of the first frame that can be matched
  SE3 T_world_camera_;                        ///< of the last frame that was not lost
  bool was_lost_ = false;
  Replay replay_;
  DepthImage gated_m_;
};

}  // namespace fusebench::systems::bundlefusion
