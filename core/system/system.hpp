// Interface of a system: receives frames, returns a pose and a status for each, and a surface at the end.
// Running, evaluating and comparing systems uses this interface only.
#pragma once

#include <optional>
#include <variant>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/estimator/health/frame_outcome.hpp"
#include "core/estimator/health/frame_report.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "core/estimator/places/loops/loop_closure.hpp"

namespace fusebench::system {

/// Reconstruction of a system in the world: a TSDF, a mesh (a point cloud if it has no triangles), or none.
using Surface = std::variant<std::monostate, tsdf::TsdfVolume, Mesh>;

/// One run of a system over one recording.
class System {
 public:
  System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;
  virtual ~System() = default;

  /// Processes the next frame (time increases). A lost frame is an outcome; errors end the run.
  [[nodiscard]] virtual Result<health::FrameOutcome> process(const RgbdFrame& frame) = 0;

  /// Report of a filter on the last frame; null for systems without one.
  [[nodiscard]] virtual const health::FrameReport* filter_report() const { return nullptr; }

  /// After the last frame: revised poses of the frames that have one; the surface is then at these poses.
  /// Nothing if the poses of process() are final. Errors end the run.
  [[nodiscard]] virtual Result<std::optional<Trajectory>> revise() { return std::nullopt; }

  /// Places and loops of the system; null if it does not detect loops. Valid until take_surface().
  [[nodiscard]] virtual const loops::LoopClosure* loops() const { return nullptr; }

  /// Moves the surface out and ends the use of the system.
  [[nodiscard]] virtual Surface take_surface() = 0;
};

}  // namespace fusebench::system
