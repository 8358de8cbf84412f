// Poses of chunks in the world: one keyframe for each chunk, matched with all others (Dai et al. 2017, Sec.
// 4.3: global inter-chunk pose optimization).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/baselines/bundlefusion/pose_adjustment.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::bundlefusion {

class KeyframeGraph {
 public:
  /// workers must outlive the graph.
  KeyframeGraph(const config::BundlefusionConfig& config, const Workers& workers)
      : config_(config), workers_(workers) {}

  /// Adds a keyframe, places it if it matches a placed one (the first one always), and optimises all poses;
  /// then retries one unplaced keyframe. T_world_guess: optional start of the optimisation. Returns its
  /// index.
  std::size_t add(View keyframe, const std::optional<SE3>& T_world_guess);

  /// Retries unplaced keyframes until none can be placed, and optimises all poses with depth.
  void finish();

  /// Poses; nothing for unplaced keyframes.
  [[nodiscard]] const Poses& T_world_keyframe() const { return T_world_keyframe_; }
  [[nodiscard]] std::span<const FramePair> pairs() const { return pairs_; }

 private:
  bool place(std::size_t keyframe, const std::optional<SE3>& T_world_guess);
  void retry_one();
  void adjust();
  bool remove_worst_pair();
  void drop_disconnected();

  config::BundlefusionConfig config_;
  const Workers& workers_;
  std::vector<View> keyframes_;
  std::vector<FramePair> pairs_;
  Poses T_world_keyframe_;
  std::size_t retried_ = 0;  ///< keyframe of the last retry
};

}  // namespace fusebench::baselines::bundlefusion
