// Loops: places that are seen again, and all poses of a recording made consistent with them at its end. The
// paper leaves this open ("has not achieved loop closure with fast camera motion").
//
// Fused frames become places every few frames. Each is compared with the older ones by what it looks like
// (fern_code.hpp); the most similar are verified by features and by depth in both directions
// (place_verification.hpp). An edge is accepted if it agrees with the poses so far within their drift, or
// with another edge near to it in time: appearance alone never moves anything. The graph of places is
// optimised once (pose_graph.hpp); between places, poses move with their neighbours.
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
#include "core/config/config.hpp"
#include "core/filter/filter_state.hpp"
#include "core/loops/place.hpp"
#include "core/loops/place_verification.hpp"
#include "core/loops/pose_graph.hpp"

namespace fusebench::loops {

/// A pair of places that was looked at.
struct LoopCandidate {
  std::size_t known = 0;  ///< places, by index
  std::size_t query = 0;
  double dissimilarity = 0;
  VerifiedPair pair;
  double chi2 = 0;  ///< squared distance to the poses so far, by drift and the edge's own error
  bool accepted = false;
  std::string verdict;  ///< why it was taken or refused
};

/// What is needed to fuse a frame again.
struct FusedFrame {
  std::int64_t timestamp_ns = 0;
  filter::FilterState state;
};

class LoopClosure {
 public:
  /// The references must outlive it.
  LoopClosure(const config::Config& config, const SensorRig& rig) : config_(config), rig_(rig) {}

  [[nodiscard]] bool enabled() const { return config_.loops.mode != config::LoopMode::off; }

  /// A frame that was fused (compensated, gated, with colour), with the estimate that it was fused at.
  void add_fused(const RgbdFrame& frame, const filter::GaussianState& estimate, double blur_px);
  /// The pose of a frame that has one, fused or not.
  void add_pose(std::int64_t timestamp_ns, const SE3& T_world_camera);

  /// Decides which loops are accepted, after the last frame, and with mode final optimises. True if poses
  /// change. Errors: those of optimised_poses().
  [[nodiscard]] Result<bool> close();

  /// Of the frames given to add_pose(), after close().
  [[nodiscard]] Trajectory corrected_trajectory() const;
  /// The state that the frame of that stamp was fused at, corrected; nothing if it was not fused.
  [[nodiscard]] std::optional<filter::FilterState> corrected_state(std::int64_t timestamp_ns) const;

  [[nodiscard]] std::span<const Place> places() const { return places_; }
  [[nodiscard]] std::span<const LoopCandidate> candidates() const { return candidates_; }
  /// A candidate a line: stamps of both frames [s]; pose of the query's camera in that of the place (tx ty tz
  /// [m], qx qy qz qw) and its standard deviations by axis (rotation [rad], position [m]), identity and 0
  /// where there is none; dissimilarity, matches, inliers, shares of depth that is consistent and in free
  /// space, chi2, "accepted" or "refused", and why.
  [[nodiscard]] std::string table() const;

 private:
  void look_for_loops(std::size_t query);
  [[nodiscard]] GraphEdge path_edge(std::size_t a, std::size_t b) const;
  [[nodiscard]] GraphEdge loop_edge(const LoopCandidate& candidate) const;
  [[nodiscard]] double chi2_of(const LoopCandidate& candidate) const;
  [[nodiscard]] bool agree(const LoopCandidate& a, const LoopCandidate& b) const;
  void decide();
  [[nodiscard]] Result<void> optimise();
  [[nodiscard]] SE3 corrected(std::int64_t timestamp_ns, const SE3& T_world_camera) const;

  const config::Config& config_;
  const SensorRig& rig_;
  std::vector<Place> places_;
  std::vector<SE3> optimised_;  ///< poses of places; empty until close() changes something
  std::vector<LoopCandidate> candidates_;
  std::vector<FusedFrame> fused_;
  Trajectory poses_;
  int fused_since_place_ = 0;
};

}  // namespace fusebench::loops
