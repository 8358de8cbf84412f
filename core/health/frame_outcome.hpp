// What every system says of a frame, whatever its method.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/types.hpp"
#include "core/health/stage_times.hpp"

namespace fusebench::health {

enum class FrameStatus {
  initialised,    ///< the first frame that could be used
  tracked,        ///< the update was accepted; the frame was fused unless its health is occluded or repeated.
                  ///< Or the images are the last ones and asked for none: reason says so
  relocalised,    ///< was lost and has found its place again by a frame seen before; tracked from there
  other_segment,  ///< tracked apart from the map (map_segments.hpp): its pose counts once it is joined
  lost,           ///< too few usable patches, or after a gap ones that do not fit, and no keyframe was
                  ///< recognised: the prediction was kept, the frame not fused. Or no start yet
};
[[nodiscard]] std::string_view to_string(FrameStatus status);
/// True of a frame that has a pose in the map.
[[nodiscard]] bool is_in_map(FrameStatus status);

struct FrameOutcome {
  std::int64_t timestamp_ns = 0;  ///< the frame's stamp
  std::int64_t capture_ns = 0;    ///< the instant that the pose is of
  FrameStatus status = FrameStatus::lost;
  std::string reason;  ///< why it is lost, started from again, or has no update; empty otherwise
  SE3 T_world_camera;
  std::size_t segment = 0;         ///< that the frame was processed in; 0: the map
  std::size_t joined_segment = 0;  ///< that this frame joined to the map; 0: none
  bool poses_corrected = false;    ///< by a loop after this frame: all poses so far have moved
  std::size_t model_blocks = 0;    ///< of the system's TSDF, if it has one
  StageTimes stages;               ///< wall time; the only part that is not reproducible
};

}  // namespace fusebench::health
