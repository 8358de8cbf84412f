// Loop closure: recognises places and makes all poses of a recording consistent with them. The paper leaves
// this open ("has not achieved loop closure with fast camera motion").
//
// Every few fused frames, one becomes a place. It is compared with the older places by appearance and by
// position (place_search.hpp). The most similar and the nearest ones are verified by features and by depth in
// both directions (core/estimator/places). loop_edges.hpp decides which edges are accepted. The pose graph is
// optimised at the end, or online when a loop contradicts the poses (pose_graph.hpp). Other poses move with
// their neighbouring places.
//
// All computations are in the odometry frame (odometry_world.hpp). A self-relocalisation to a place becomes
// an edge.
//
// Results do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/places/loops/loop_edges.hpp"
#include "core/estimator/places/loops/odometry_world.hpp"
#include "core/estimator/places/loops/place.hpp"

namespace fusebench::loops {

/// Data to fuse a frame again, in the odometry frame.
struct FusedFrame {
  std::int64_t timestamp_ns = 0;
  filter::FilterState state;
};

class LoopClosure {
 public:
  /// The references must outlive it.
  LoopClosure(const config::Config& config, const SensorRig& rig) : config_(config), rig_(rig) {}

  [[nodiscard]] bool enabled() const;

  /// Adds a fused frame (compensated, gated, with colour) and the estimate at which it was fused.
  void add_fused(const RgbdFrame& frame, const filter::GaussianState& estimate, double blur_px);
  /// Adds a self-relocalisation: the pose predicted for the lost tracker and the pose found with the fused
  /// frame of that stamp. Call it before the other calls for that frame.
  void add_relocalisation(const filter::GaussianState& predicted, const filter::GaussianState& found,
                          std::int64_t found_by_ns);
  /// Adds the pose of a frame, fused or not.
  void add_pose(std::int64_t timestamp_ns, const SE3& T_world_camera);

  /// In mode online: true while corrections are left.
  [[nodiscard]] bool may_correct_online() const;
  /// In mode online, after add_fused() and add_pose(): the transform T_corrected_current, if the last frame
  /// contradicts the poses. Estimate, model and keyframes must be moved by it. Errors: those of
  /// optimised_poses().
  [[nodiscard]] Result<std::optional<SE3>> correct_online();

  /// Decides, after the last frame, which loops are accepted. In modes final and online, optimises. True if
  /// poses changed. Errors: those of optimised_poses().
  [[nodiscard]] Result<bool> close();

  // After close() or a correction:
  /// Poses of the frames given to add_pose().
  [[nodiscard]] Trajectory corrected_trajectory() const;
  /// Corrected state at which the frame of that stamp was fused; nothing if it was not fused.
  [[nodiscard]] std::optional<filter::FilterState> corrected_state(std::int64_t timestamp_ns) const;
  /// Corrected camera pose at the fused frame that is nearest in time. Requires at least one fused frame.
  [[nodiscard]] SE3 corrected_pose_near(std::int64_t timestamp_ns) const;

  /// Final poses with the given loops (pair.same, all accepted) instead of the detected ones. With
  /// ground-truth loops this gives the error that remains. Errors: those of optimised_poses().
  [[nodiscard]] Result<Trajectory> poses_with(std::vector<LoopCandidate> loops) const;

  [[nodiscard]] int online_corrections() const { return corrections_; }
  [[nodiscard]] std::span<const Place> places() const { return places_; }
  [[nodiscard]] std::span<const LoopCandidate> candidates() const { return candidates_; }
  /// Covariance of the pose of a verified pair: rotation on the right (rad), position in the frame of the
  /// known place (m).
  [[nodiscard]] Matrix6d covariance_of(const LoopCandidate& candidate) const;

 private:
  /// A frame with a pose.
  struct PosedFrame {
    std::int64_t timestamp_ns = 0;
    SE3 T_odometry_camera;
    std::size_t relocalisations = 0;  ///< number of relocalisations up to and including this frame
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
  bool poses_are_wrong_ = false;  ///< a loop of the last place contradicts the poses
  std::size_t fused_at_attempt_ = 0;
  int corrections_ = 0;
};

}  // namespace fusebench::loops
