// What is asked of a program that is compared with ours.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::peers {

/// One frame as every contestant gets it.
struct ContestFrame {
  RgbdFrame frame;  ///< as the recording gives it: undistorted, depth registered to colour
  RgbdFrame
      fusible;  ///< as our pipeline fuses it: motion within it compensated, depth that it does not trust 0
  SE3 T_world_camera;  ///< as our pipeline estimated it
};

/// The model that a fusion has made.
struct FusedSurface {
  std::size_t blocks = 0;              ///< allocated
  int block_side_voxels = 0;           ///< a block is a cube
  std::vector<Vector3d> points_world;  ///< where the distance field crosses zero, metres
};

/// A program that does a part of what our pipeline does, frame by frame. All calls may throw what its library
/// throws.
class Contestant {
 public:
  Contestant() = default;
  virtual ~Contestant() = default;
  Contestant(const Contestant&) = delete;
  Contestant& operator=(const Contestant&) = delete;

  /// Brings the frame into the library's own types. Not timed.
  virtual void receive(const ContestFrame& frame) = 0;
  /// The work on the received frame. Timed.
  virtual void work() = 0;
  /// The motion that work() found, for trackers: T_before_now, of the camera. Nothing if it found none.
  [[nodiscard]] virtual std::optional<SE3> motion() const { return std::nullopt; }
  /// For fusions, after the last frame. Not timed.
  [[nodiscard]] virtual FusedSurface surface() { return {}; }
};

/// Of the field that all fusions make.
struct FieldSettings {
  double voxel_m = 0.01;
  double truncation_m = 0.05;
  double max_depth_m = 0;  ///< no depth is above it
};

/// What it is compared with.
enum class Task { tracking, fusion };

struct Peer {
  std::string name;      ///< with its version
  std::string settings;  ///< what is not a default of the library
  std::string package;   ///< Debian's
  Task task = Task::tracking;
  /// A fresh one; empty if the package was not there when this program was built.
  std::function<std::unique_ptr<Contestant>(const PinholeCamera&, const FieldSettings&)> make = {};
};

}  // namespace fusebench::peers
