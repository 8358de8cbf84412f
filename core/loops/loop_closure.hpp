// Loops: places that are seen again, and all poses of a recording made consistent with them at its end. The
// paper leaves this open ("has not achieved loop closure with fast camera motion").
//
// Fused frames become places every few frames. Each is compared with the older ones by what it looks like,
// and by where the path leads (place_search.hpp); the most similar and the nearest are verified by
// features and by depth in both directions (core/places). Which edges are accepted is in loop_edges.hpp. The
// graph of places is optimised at the end, or online as well when a loop shows that the poses are wrong
// (pose_graph.hpp); between places, poses move with their neighbours.
//
// All of this works in the world of the odometry (odometry_world.hpp). A lost tracker that finds itself by a
// place has closed a loop: the place becomes an edge.
//
// The same frames give the same bytes, whatever the number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/loops/loop_edges.hpp"
#include "core/loops/odometry_world.hpp"
#include "core/loops/place.hpp"

namespace fusebench::loops {

/// What is needed to fuse a frame again; in the world of the odometry.
struct FusedFrame {
  std::int64_t timestamp_ns = 0;
  filter::FilterState state;
};

class LoopClosure {
 public:
  /// The references must outlive it.
  LoopClosure(const config::Config& config, const SensorRig& rig) : config_(config), rig_(rig) {}

  [[nodiscard]] bool enabled() const;

  /// A frame that was fused (compensated, gated, with colour), with the estimate that it was fused at.
  void add_fused(const RgbdFrame& frame, const filter::GaussianState& estimate, double blur_px);
  /// A lost tracker was predicted to be there, and has found itself by the fused frame of that stamp; before
  /// the calls for that frame.
  void add_relocalisation(const filter::GaussianState& predicted, const filter::GaussianState& found,
                          std::int64_t found_by_ns);
  /// The pose of a frame that has one, fused or not.
  void add_pose(std::int64_t timestamp_ns, const SE3& T_world_camera);

  /// With mode online, as long as there is a correction left.
  [[nodiscard]] bool may_correct_online() const;
  /// With mode online, after the last calls of these two: how the world of the estimate moves
  /// (T_corrected_current), if the frame showed that the poses are wrong. All that is in it, estimate, model
  /// and keyframes, then has to move. Errors: those of optimised_poses().
  [[nodiscard]] Result<std::optional<SE3>> correct_online();

  /// Decides which loops are accepted, after the last frame, and with mode final or online optimises. True if
  /// poses change. Errors: those of optimised_poses().
  [[nodiscard]] Result<bool> close();

  // After close() or a correction:
  /// Of the frames given to add_pose().
  [[nodiscard]] Trajectory corrected_trajectory() const;
  /// The state that the frame of that stamp was fused at, corrected; nothing if it was not fused.
  [[nodiscard]] std::optional<filter::FilterState> corrected_state(std::int64_t timestamp_ns) const;
  /// Of the camera, at the fused frame that is nearest in time; there has to be one.
  [[nodiscard]] SE3 corrected_pose_near(std::int64_t timestamp_ns) const;

  /// The poses at the end with these loops (pair.same, all accepted) in place of those that were found: with
  /// true ones it tells how much is left to be found. Errors: those of optimised_poses().
  [[nodiscard]] Result<Trajectory> poses_with(std::vector<LoopCandidate> loops) const;

  [[nodiscard]] int online_corrections() const { return corrections_; }
  [[nodiscard]] std::span<const Place> places() const { return places_; }
  [[nodiscard]] std::span<const LoopCandidate> candidates() const { return candidates_; }
  /// Of a verified pair's pose: rotation on the right (rad), position in the frame of the known place (m).
  [[nodiscard]] Matrix6d covariance_of(const LoopCandidate& candidate) const;

 private:
  /// A frame that has a pose.
  struct PosedFrame {
    std::int64_t timestamp_ns = 0;
    SE3 T_odometry_camera;
    std::size_t relocalisations = 0;  ///< before it, its own included
  };
  [[nodiscard]] bool was_found_since_last_place() const {
    return !places_.empty() && places_.back().relocalisations < odometry_.relocalisations();
  }
  [[nodiscard]] Matrix6d camera_covariance(const filter::GaussianState& in_odometry) const;
  void add_relocalisation_edge(std::size_t query);
  [[nodiscard]] std::size_t place_near(std::int64_t timestamp_ns) const;
  void look_for_loops(std::size_t query);
  [[nodiscard]] bool is_candidate(std::size_t known, std::size_t query) const;
  [[nodiscard]] bool is_accepted(std::size_t relocalisation) const;
  [[nodiscard]] Result<void> optimise();
  [[nodiscard]] SE3 corrected(const PosedFrame& frame) const;
  [[nodiscard]] std::size_t place_before(std::int64_t timestamp_ns) const;
  [[nodiscard]] SE3 T_current_camera(std::size_t place) const;
  [[nodiscard]] bool contradicts_current_poses(const LoopCandidate& candidate) const;
  [[nodiscard]] bool is_large(const SE3& motion) const;

  const config::Config& config_;
  const SensorRig& rig_;
  std::vector<Place> places_;
  std::vector<SE3> optimised_;  ///< poses of places; empty until close() changes something
  std::vector<LoopCandidate> candidates_;
  std::vector<FusedFrame> fused_;
  std::vector<PosedFrame> poses_;
  OdometryWorld odometry_;
  int fused_since_place_ = 0;
  bool poses_are_wrong_ = false;  ///< a loop of the last place says so
  std::size_t fused_at_attempt_ = 0;
  int corrections_ = 0;
};

}  // namespace fusebench::loops
