#include "core/baselines/elasticfusion/deformation/loop_closer.hpp"

#include <cmath>

#include "core/baselines/elasticfusion/deformation/map_deformation.hpp"
#include "core/baselines/elasticfusion/deformation/view_registration.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

namespace {

constexpr std::size_t kLocalSpacing = 5000;  // surfels for each node
constexpr std::size_t kGlobalSpacing = 5 * kLocalSpacing;
constexpr int kColumns = 32, kRows = 24;      // grid of constraints of a local loop
constexpr std::size_t kHeldOfALocalLoop = 3;  // number of points that later global loops keep together
constexpr std::int32_t kAgeOfPlaces = 300;    // frames
constexpr double kFewestMatches = 2400;       // of 80x60
constexpr double kFewestMatchesLost = 1400;
constexpr std::size_t kGlobalConstraints = 50;
constexpr double kLeastErrorBefore_m = 0.06;
constexpr double kMostErrorAfter_m = 3e-4;
constexpr double kMostEnergy = 0.12;

/// Ratio of the number of pixels to 640x480, the reference size of the gates.
double size_of(const PinholeCamera& camera) {
  return static_cast<double>(camera.width_px) * static_cast<double>(camera.height_px) / (640.0 * 480.0);
}

/// Points that a registration aligns: their positions at `time` and their targets on the inactive model, at
/// its time.
std::vector<PointConstraint> registered_points(const surfels::SurfelView& view,
                                               const surfels::SurfelView& inactive, const SE3& T_world_camera,
                                               std::int32_t time, const surfels::SurfelMap& map) {
  const int width = view.surfel.width, height = view.surfel.height;
  std::vector<PointConstraint> together;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const std::size_t pixel =
          view.surfel.index((2 * column + 1) * width / (2 * kColumns), (2 * row + 1) * height / (2 * kRows));
      const std::int32_t old = inactive.surfel.data[pixel];
      if (view.surfel.data[pixel] == surfels::kNoSurfel || old == surfels::kNoSurfel) continue;
      const Vector3d point = view.point.at(pixel).cast<double>();
      together.push_back({{view.T_world_camera * point, time},
                          {T_world_camera * point, map.created[static_cast<std::size_t>(old)]},
                          true});
    }
  }
  return together;
}

/// Adds constraints that move sources to the current positions of their targets. pinned: also fixes the
/// targets.
void add_fixed(const std::vector<PointConstraint>& together, bool pinned,
               std::vector<PointConstraint>& constraints) {
  for (const PointConstraint& constraint : together) {
    constraints.push_back({constraint.source, constraint.target, false});
    if (pinned) constraints.push_back({constraint.target, constraint.target, false});
  }
}

}  // namespace

LoopCloser::LoopCloser(const config::ElasticfusionConfig& config, const PinholeCamera& camera,
                       const Workers& workers)
    : config_(config), camera_(camera), workers_(workers), places_(config_, workers) {}

bool LoopCloser::close(const surfels::LiveFrame& live, const surfels::SurfelView& view, std::int32_t time,
                       surfels::SurfelMap& map, std::vector<TimedPose>& poses) {
  if (config_.loops == config::ElasticfusionLoops::none) return false;
  bool closed = false;
  if (config_.loops == config::ElasticfusionLoops::all) {
    FernPlace here = fern_place(live, view, time);
    closed = close_global(here, map, poses);
    here.view.T_world_camera = poses.back().T_world_camera;
    places_.offer(here);
  }
  return closed || close_local(view, time, map, poses);
}

std::optional<SE3> LoopCloser::relocate(const surfels::LiveFrame& live, const surfels::SurfelView& view,
                                        std::int32_t time) const {
  surfels::SurfelView nothing = view;  // no view of the model exists for a lost camera
  for (std::int32_t& surfel : nothing.surfel.data) surfel = surfels::kNoSurfel;
  const auto found = places_.find(fern_place(live, nothing, time), 0, kFewestMatchesLost);
  if (!found) return std::nullopt;
  return places_[found->place].view.T_world_camera * found->T_place_camera;
}

bool LoopCloser::close_global(const FernPlace& here, surfels::SurfelMap& map, std::vector<TimedPose>& poses) {
  const auto found = places_.find(here, kAgeOfPlaces, kFewestMatches);
  if (!found) return false;
  const FernPlace& place = places_[found->place];
  const SE3& T_world_place = place.view.T_world_camera;
  const SE3 T_world_camera = T_world_place * found->T_place_camera;
  std::vector<PointConstraint> together;
  std::vector<std::size_t> measured;
  for (std::size_t pixel = 0; pixel < here.view.surfel.data.size(); ++pixel) {
    if (here.view.point.z.data[pixel] > 0) measured.push_back(pixel);
  }
  for (std::size_t i = 0; i < kGlobalConstraints; ++i) {
    const std::size_t pixel = measured[i * measured.size() / kGlobalConstraints];
    const Vector3d point = here.view.point.at(pixel).cast<double>();
    together.push_back(
        {{here.view.T_world_camera * point, here.time}, {T_world_camera * point, place.time}, true});
  }
  std::vector<PointConstraint> constraints = held_together_;
  add_fixed(together, true, constraints);  // the stored place is fixed
  auto graph = graph_of(map, camera_, kGlobalSpacing);
  if (!graph) return false;
  const auto result = graph->optimise(constraints);
  if (!result || result->error_before_m < kLeastErrorBefore_m || result->error_after_m >= kMostErrorAfter_m ||
      result->energy >= kMostEnergy)
    return false;
  held_together_.insert(held_together_.end(), together.begin(), together.end());
  bend(*graph, T_world_camera, map, poses);
  reactivate(T_world_camera, here.time, map);
  ++global_loops_;
  return true;
}

bool LoopCloser::close_local(const surfels::SurfelView& view, std::int32_t time, surfels::SurfelMap& map,
                             std::vector<TimedPose>& poses) {
  if (time <= config_.time_window) return false;  // all surfels are still active
  const double size = size_of(camera_);
  const double fewest = config_.loop_min_inliers * size;
  const surfels::SurfelView& inactive = inactive_view(view.T_world_camera, time, map);
  if (static_cast<double>(inactive.seen) < fewest || static_cast<double>(view.seen) < fewest) return false;
  const tracking::TrackedMotion motion = register_view(view, inactive, config_, workers_);
  if (motion.was_dropped || motion.matches <= fewest ||
      motion.error_m >= config_.loop_max_error_m / std::sqrt(size) ||
      motion.variance() >= config_.loop_max_variance / size)
    return false;
  const SE3 T_world_camera = view.T_world_camera * motion.T_view_camera;
  const std::vector<PointConstraint> together = registered_points(view, inactive, T_world_camera, time, map);
  if (together.empty()) return false;
  // Parts deformed by earlier local loops are fixed. Before the first local loop, the targets are pinned
  // instead.
  std::vector<PointConstraint> constraints;
  add_fixed(together, last_local_loop_ < 0, constraints);
  auto graph = graph_of(map, camera_, kLocalSpacing);
  if (!graph || !graph->optimise(constraints, last_local_loop_)) return false;
  const std::size_t step = (together.size() + kHeldOfALocalLoop - 1) / kHeldOfALocalLoop;
  for (std::size_t i = 0; i < together.size(); i += step) held_together_.push_back(together[i]);
  bend(*graph, T_world_camera, map, poses);
  reactivate(T_world_camera, time, map);
  last_local_loop_ = time;
  ++local_loops_;
  return true;
}

void LoopCloser::bend(const DeformationGraph& graph, const SE3& T_world_camera, surfels::SurfelMap& map,
                      std::vector<TimedPose>& poses) {
  deform(graph, workers_, map);
  for (TimedPose& pose : poses) pose.T_world_camera = graph.moved(pose.T_world_camera, pose.time);
  poses.back().T_world_camera = T_world_camera;
  places_.deform(graph);
  for (PointConstraint& constraint : held_together_) {
    constraint.source = graph.moved(constraint.source);
    constraint.target = graph.moved(constraint.target);
  }
}

const surfels::SurfelView& LoopCloser::inactive_view(const SE3& T_world_camera, std::int32_t time,
                                                     const surfels::SurfelMap& map) {
  const surfels::SurfelChoice choice{time, config_.time_window, false,
                                     static_cast<float>(config_.stable_confidence)};
  renderer_.render(map, camera_, T_world_camera, choice, workers_, inactive_);
  return inactive_;
}

/// Activates the inactive surfels in view.
void LoopCloser::reactivate(const SE3& T_world_camera, std::int32_t time, surfels::SurfelMap& map) {
  for (const std::int32_t surfel : inactive_view(T_world_camera, time, map).surfel.data) {
    if (surfel != surfels::kNoSurfel) map.updated[static_cast<std::size_t>(surfel)] = time;
  }
}

}  // namespace fusebench::baselines::elasticfusion::deformation
