// Where chunks are in the world: one keyframe a chunk, matched with all others (Dai et al. 2017, Sec. 4.3:
// global inter-chunk pose optimization).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/config/groups/systems_config.hpp"
#include "core/systems/bundlefusion/pose_adjustment.hpp"

namespace fusebench::systems::bundlefusion {

class KeyframeGraph {
 public:
  /// workers must outlive the graph.
  KeyframeGraph(const config::BundlefusionConfig& config, const Workers& workers)
      : config_(config), workers_(workers) {}

  /// Adds a keyframe, places it if it matches a placed one (the first one always), and adjusts all; then
  /// tries one of those again that have no place. The guess, if there is one, is where adjusting starts.
  /// Returns its index.
  std::size_t add(View keyframe, const std::optional<SE3>& T_world_guess);

  /// The end: tries those without a place until none finds one, and adjusts all with depth.
  void finish();

  /// Nothing for keyframes without a place.
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
  std::size_t retried_ = 0;  ///< the keyframe that was tried again last
};

}  // namespace fusebench::systems::bundlefusion
