#include "core/health/frame_outcome.hpp"

namespace fusebench::health {

std::string_view to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::initialised:
      return "initialised";
    case FrameStatus::tracked:
      return "tracked";
    case FrameStatus::relocalised:
      return "relocalised";
    case FrameStatus::lost:
      break;
  }
  return "lost";
}

}  // namespace fusebench::health
