// Outcome of a frame, common to all systems.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/types.hpp"
#include "core/estimator/health/stage_times.hpp"

namespace fusebench::health {

enum class FrameStatus {
  initialised,  ///< first usable frame
  /// update accepted, and fused unless its health is occluded or repeated; or no update for repeated images
  /// (see reason)
  tracked,
  relocalised,  ///< was lost, relocalised by a keyframe, and tracked from there
  /// tracked in a separate segment (map_segments.hpp); its pose is valid once the segment is joined
  other_segment,
  /// too few usable patches (after a gap: patches that do not fit) and no keyframe recognised. The prediction
  /// is kept and the frame is not fused. Also before the first start
  lost,
};
[[nodiscard]] std::string_view to_string(FrameStatus status);
/// True if a frame has a pose in the map.
[[nodiscard]] bool is_in_map(FrameStatus status);

struct FrameOutcome {
  std::int64_t timestamp_ns = 0;  ///< the frame's stamp
  std::int64_t capture_ns = 0;    ///< instant of the pose
  FrameStatus status = FrameStatus::lost;
  std::string reason;  ///< why it is lost, restarted, or without update; empty otherwise
  SE3 T_world_camera;
  std::size_t segment = 0;         ///< segment of the frame; 0: the map
  std::size_t joined_segment = 0;  ///< segment that this frame joined to the map; 0: none
  bool poses_corrected = false;    ///< a loop after this frame corrected all earlier poses
  std::size_t model_blocks = 0;    ///< blocks of the system's TSDF, if it has one
  StageTimes stages;               ///< wall time; not reproducible
};

}  // namespace fusebench::health
