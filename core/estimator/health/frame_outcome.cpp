#include "core/estimator/health/frame_outcome.hpp"

namespace fusebench::health {

std::string_view to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::initialised:
      return "initialised";
    case FrameStatus::tracked:
      return "tracked";
    case FrameStatus::relocalised:
      return "relocalised";
    case FrameStatus::other_segment:
      return "other-segment";
    case FrameStatus::lost:
      break;
  }
  return "lost";
}

bool is_in_map(FrameStatus status) {
  return status != FrameStatus::lost && status != FrameStatus::other_segment;
}

}  // namespace fusebench::health
