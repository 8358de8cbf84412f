// A chunk: eleven frames in a row, the last one shared with the next chunk, each placed in the camera of the
// first one (Dai et al. 2017, Sec. 4.3: local intra-chunk pose optimization).
#pragma once

#include <vector>

#include "core/config/groups/systems_config.hpp"
#include "core/systems/bundlefusion/pose_adjustment.hpp"

namespace fusebench::systems::bundlefusion {

class Chunk {
 public:
  /// The first frame; workers must outlive the chunk.
  Chunk(View first, const config::BundlefusionConfig& config, const Workers& workers);

  /// Adds the next frame, and places it if it matches one that is placed. Says whether it did.
  bool add(View view);

  [[nodiscard]] std::size_t size() const { return views_.size(); }
  /// Of its frames; nothing where a frame matched none.
  [[nodiscard]] const Poses& T_first_camera() const { return T_first_camera_; }
  /// The last frame that was placed.
  [[nodiscard]] std::size_t last_placed() const;

  /// Adjusts all poses, with depth. False if what it has is no chunk: a single frame, or matches that
  /// contradict each other or the depth.
  [[nodiscard]] bool close();

  /// The chunk in the camera of its first frame: the keypoints that were matched within it, each track once.
  [[nodiscard]] View merged(const PinholeCamera& camera) const;

  /// The first frame of the next chunk; the chunk is of no use afterwards.
  [[nodiscard]] View take(std::size_t frame) { return std::move(views_[frame]); }

 private:
  [[nodiscard]] std::vector<const DepthCloud*> clouds() const;
  [[nodiscard]] bool matches_are_consistent() const;
  [[nodiscard]] bool depth_is_consistent() const;

  config::BundlefusionConfig config_;
  const Workers& workers_;
  std::vector<View> views_;
  std::vector<FramePair> pairs_;
  Poses T_first_camera_;
};

}  // namespace fusebench::systems::bundlefusion
