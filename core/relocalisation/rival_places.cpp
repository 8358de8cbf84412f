#include "core/relocalisation/rival_places.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"
#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench::relocalisation {

bool is_elsewhere(const SE3& T_world_a, const SE3& T_world_b, const config::RelocalisationConfig& config) {
  const double apart_m = (T_world_a.translation - T_world_b.translation).norm();
  return apart_m > config.rival_separation * config.keyframe_distance_m ||
         rotation_angle_rad(T_world_a.rotation, T_world_b.rotation) >
             config.rival_separation * radians(config.keyframe_angle_deg);
}

void RivalPlaces::observe(std::int64_t timestamp_ns, std::span<const FoundPlace> best_first) {
  // Of a room that looks alike on two sides, only the direction differs.
  const double least_m = config_.rival_separation * config_.keyframe_distance_m;
  double nearest_m = std::numeric_limits<double>::infinity();
  double furthest_m = 0;
  for (std::size_t i = 0; i < best_first.size(); ++i) {
    for (std::size_t j = i + 1; j < best_first.size(); ++j) {
      const SE3& a = best_first[i].T_world_camera;
      const SE3& b = best_first[j].T_world_camera;
      if (!is_elsewhere(a, b, config_)) continue;
      const double apart_m = std::max((a.translation - b.translation).norm(), least_m);
      nearest_m = std::min(nearest_m, apart_m);
      furthest_m = std::max(furthest_m, apart_m);
    }
  }
  if (furthest_m == 0) return;
  timestamp_ns_ = timestamp_ns;
  nearest_m_ = nearest_m;
  furthest_m_ = furthest_m;
  rivals_world_m_.clear();
  for (const FoundPlace& place : best_first) rivals_world_m_.push_back(place.T_world_camera.translation);
}

bool RivalPlaces::repeats_near(std::int64_t timestamp_ns, const Vector3d& position_m) const {
  if (seconds_between(timestamp_ns_, timestamp_ns) > config_.rivals_within_s) return false;
  return std::ranges::any_of(
      rivals_world_m_, [&](const Vector3d& rival_m) { return (position_m - rival_m).norm() <= furthest_m_; });
}

bool RivalPlaces::is_only_one(std::int64_t timestamp_ns, std::span<const FoundPlace> allowed,
                              const PredictedPosition& predicted) const {
  const FoundPlace& first = allowed.front();
  if (std::ranges::any_of(allowed, [&](const FoundPlace& place) {
        return is_elsewhere(place.T_world_camera, first.T_world_camera, config_);
      })) {
    return false;
  }
  const Vector3d& position_m = first.T_world_camera.translation;
  if (!repeats_near(timestamp_ns, position_m)) return true;
  constexpr double kSigmas = 3;
  return std::max((position_m - predicted.world_m).norm(), kSigmas * predicted.sigma_m) < 0.5 * nearest_m_;
}

}  // namespace fusebench::relocalisation
