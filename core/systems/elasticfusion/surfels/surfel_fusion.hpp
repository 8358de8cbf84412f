// A frame becomes part of the model: measurements join the surfels that they are of or become new ones, and
// what new measurements contradict goes.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/systems/elasticfusion/surfels/index_map.hpp"
#include "core/systems/elasticfusion/surfels/live_frame.hpp"
#include "core/systems/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::systems::elasticfusion::surfels {

/// A frame's place in space and time.
struct FusedPose {
  SE3 T_world_camera;
  std::int32_t now = 0;  ///< number of the frame
  float motion_weight = 1;
};

class SurfelFusion {
 public:
  /// workers must outlive it.
  SurfelFusion(const PinholeCamera& camera, float stable_confidence, std::int32_t time_window,
               const Workers& workers)
      : camera_(camera), stable_confidence_(stable_confidence), window_(time_window), workers_(workers) {}

  /// Adds a surfel for each pixel with a normal.
  void start(const LiveFrame& live, const FusedPose& pose, SurfelMap& map);

  /// One pixel in four, of even rows and columns or of odd ones in turn: a measurement belongs to the active
  /// surfel that is nearest to its ray, of those within 5 cm along the ray and 0.5 rad of its normal. Of
  /// several measurements of one surfel the nearest counts. Measurements without one are new surfels.
  /// Then removes what does not last: surfels that did not become stable within 20 frames, copies of older
  /// ones (at least three within 1 cm behind it), and those in front of what was measured now.
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
  std::vector<std::uint8_t> updated_now_;  ///< by number in the index map
};

}  // namespace fusebench::systems::elasticfusion::surfels
