// Fuses a frame into the surfel map: updates matched surfels, adds new ones, and removes contradicted ones.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/surfels/index_map.hpp"
#include "core/baselines/elasticfusion/surfels/live_frame.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// Pose and time of a frame.
struct FusedPose {
  SE3 T_world_camera;
  std::int32_t now = 0;  ///< number of the frame
  float motion_weight = 1;
};

class SurfelFusion {
 public:
  /// workers must outlive the object.
  SurfelFusion(const PinholeCamera& camera, float stable_confidence, std::int32_t time_window,
               const Workers& workers)
      : camera_(camera), stable_confidence_(stable_confidence), window_(time_window), workers_(workers) {}

  /// Adds a surfel for each pixel with a normal.
  void start(const LiveFrame& live, const FusedPose& pose, SurfelMap& map);

  /// Processes one pixel in four: even rows and columns, or odd ones, in turn. A measurement matches the
  /// active surfel nearest to its ray, within 5 cm along the ray and 0.5 rad of its normal. Of several
  /// measurements of a surfel, the nearest is used. Unmatched measurements become new surfels. Then removes
  /// surfels that were not stable after 20 frames, copies of older surfels (at least three within 1 cm behind
  /// it), and surfels in front of measured surfaces.
  void fuse(const LiveFrame& live, const FusedPose& pose, SurfelMap& map);

 private:
  struct Match {
    std::int32_t number = -1;  ///< of the surfel in the index map
    float distance_m = 0;      ///< from the ray
  };
  [[nodiscard]] std::vector<Match> find_matches(const LiveFrame& live, int phase) const;
  [[nodiscard]] Surfel measured_surfel(const LiveFrame& live, int x, int y, const FusedPose& pose) const;
  void update(const LiveFrame& live, const FusedPose& pose, int phase, SurfelMap& map);
  void remove(const FusedPose& pose, SurfelMap& map) const;
  [[nodiscard]] bool is_a_copy(std::size_t number, const SurfelMap& map) const;

  PinholeCamera camera_;
  float stable_confidence_;
  std::int32_t window_;
  const Workers& workers_;
  IndexMap index_;
  std::vector<std::uint8_t> updated_now_;  ///< indexed as the surfels of the index map
};

}  // namespace fusebench::baselines::elasticfusion::surfels
