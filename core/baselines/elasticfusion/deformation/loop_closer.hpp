// Loop closure of ElasticFusion: registers the active model with the inactive model in view and with places
// recognised by ferns, and deforms the map, the poses and the places (Whelan et al. 2015, Secs. 5 and 6).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/deformation/fern_places.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

/// Camera pose of a frame.
struct TimedPose {
  std::int64_t timestamp_ns = 0;
  std::int32_t time = 0;
  SE3 T_world_camera;
};

class LoopCloser {
 public:
  /// workers must outlive it.
  LoopCloser(const config::ElasticfusionConfig& config, const PinholeCamera& camera, const Workers& workers);

  /// Searches a loop after the fusion of a frame. If there is one, deforms the map and the poses (the last
  /// pose is that of the frame) and returns true. `view`: stable active surfels at the pose of the frame.
  bool close(const surfels::LiveFrame& live, const surfels::SurfelView& view, std::int32_t time,
             surfels::SurfelMap& map, std::vector<TimedPose>& poses);

  /// Relocalised pose of a lost camera by the stored places; nothing without a match.
  [[nodiscard]] std::optional<SE3> relocate(const surfels::LiveFrame& live, const surfels::SurfelView& view,
                                            std::int32_t time) const;

  [[nodiscard]] int local_loops() const { return local_loops_; }
  [[nodiscard]] int global_loops() const { return global_loops_; }

 private:
  [[nodiscard]] bool close_global(const FernPlace& here, surfels::SurfelMap& map,
                                  std::vector<TimedPose>& poses);
  [[nodiscard]] bool close_local(const surfels::SurfelView& view, std::int32_t time, surfels::SurfelMap& map,
                                 std::vector<TimedPose>& poses);
  void bend(const DeformationGraph& graph, const SE3& T_world_camera, surfels::SurfelMap& map,
            std::vector<TimedPose>& poses);
  void reactivate(const SE3& T_world_camera, std::int32_t time, surfels::SurfelMap& map);
  const surfels::SurfelView& inactive_view(const SE3& T_world_camera, std::int32_t time,
                                           const surfels::SurfelMap& map);

  config::ElasticfusionConfig config_;
  PinholeCamera camera_;
  const Workers& workers_;
  FernPlaces places_;
  surfels::ViewRenderer renderer_;
  surfels::SurfelView inactive_;
  std::vector<PointConstraint> held_together_;  ///< constraints of earlier loops
  std::int32_t last_local_loop_ = -1;           ///< frame of the last local loop; older parts are fixed
  int local_loops_ = 0;
  int global_loops_ = 0;
};

}  // namespace fusebench::baselines::elasticfusion::deformation
