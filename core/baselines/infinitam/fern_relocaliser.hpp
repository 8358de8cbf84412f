// Store of frames encoded by random tests on a small depth image (Glocker et al., "Real-Time RGB-D Camera
// Relocalization via Randomized Ferns for Keyframe Encoding", 2015).
#pragma once

#include <array>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/ferns/fern_code.hpp"

namespace fusebench::baselines::infinitam {

class FernRelocaliser {
 public:
  /// Tests compare the depth at random positions with random depths between depth.min_m and max_m. They are
  /// fixed for each image size.
  FernRelocaliser(const PinholeCamera& camera, const config::DepthConfig& depth, config::PeerDefects defects);

  [[nodiscard]] ferns::FernCode code_of(const DepthImage& depth_m) const;

  /// Stores the frame unless a similar one is stored; returns whether it was stored.
  bool offer(const ferns::FernCode& code, const SE3& T_world_camera);

  /// The pose of the most similar stored frame; nothing if there is none.
  [[nodiscard]] const SE3* most_similar(const ferns::FernCode& code) const;

  [[nodiscard]] std::size_t size() const { return frames_.size(); }

 private:
  struct Test {
    int x = 0;
    int y = 0;
    float depth_m = 0;
  };
  struct StoredFrame {
    ferns::FernCode code;
    SE3 T_world_camera;
  };
  [[nodiscard]] const StoredFrame* nearest(const ferns::FernCode& code) const;

  std::array<Test, ferns::kFerns * ferns::kTestsOfFern> tests_;
  std::vector<StoredFrame> frames_;
};

}  // namespace fusebench::baselines::infinitam
