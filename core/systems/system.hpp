// A system: frames in, a pose and a status a frame out, and a surface at the end. What runs, evaluates and
// compares systems knows no more of them than this.
#pragma once

#include <optional>
#include <variant>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/health/frame_outcome.hpp"
#include "core/health/frame_report.hpp"
#include "core/loops/loop_closure.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::systems {

/// What a system has reconstructed: a TSDF, of which a mesh is made; a mesh or, without triangles, a cloud of
/// points (world); or nothing.
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

  /// What a filter says of the last frame beyond its outcome; nothing of a system that has none.
  [[nodiscard]] virtual const health::FrameReport* filter_report() const { return nullptr; }

  /// The poses as the system revises them after the last frame, of the frames that have one, and its surface
  /// at these poses; nothing if the poses of process() are not changed. Errors end the run.
  [[nodiscard]] virtual Result<std::optional<Trajectory>> revise() { return std::nullopt; }

  /// The places that the system knows, and the loops that it found; nothing of one that does not look for
  /// any. Until take_surface().
  [[nodiscard]] virtual const loops::LoopClosure* loops() const { return nullptr; }

  /// The surface, and the end of everything else that the system keeps.
  [[nodiscard]] virtual Surface take_surface() = 0;
};

}  // namespace fusebench::systems
