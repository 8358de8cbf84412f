// A chunk: eleven consecutive frames, the last one shared with the next chunk, with poses in the camera frame
// of the first (Dai et al. 2017, Sec. 4.3: local intra-chunk pose optimization).
#pragma once

#include <vector>

#include "core/baselines/bundlefusion/pose_adjustment.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::bundlefusion {

class Chunk {
 public:
  /// Starts with the first frame; workers must outlive the chunk.
  Chunk(View first, const config::BundlefusionConfig& config, const Workers& workers);

  /// Adds the next frame and places it if it matches a placed one. True if it was placed.
  bool add(View view);

  [[nodiscard]] std::size_t size() const { return views_.size(); }
  /// Poses of the frames; nothing for unmatched frames.
  [[nodiscard]] const Poses& T_first_camera() const { return T_first_camera_; }
  /// Index of the last placed frame.
  [[nodiscard]] std::size_t last_placed() const;

  /// Optimises all poses with depth. False if the chunk is invalid: a single frame, or matches that
  /// contradict each other or the depth.
  [[nodiscard]] bool close();

  /// The chunk as one view in the camera of its first frame: its matched keypoints, one for each track.
  [[nodiscard]] View merged(const PinholeCamera& camera) const;

  /// Moves out a view as the first frame of the next chunk. The chunk is unusable afterwards.
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

}  // namespace fusebench::baselines::bundlefusion
