#include "core/relocalisation/rival_places.hpp"

#include <algorithm>

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"

namespace fusebench::relocalisation {

namespace {

/// One that fits nearly as well as the first, elsewhere; nullptr if there is none.
const FoundPlace* rival_of_first(std::span<const FoundPlace> best_first,
                                 const config::RelocalisationConfig& config) {
  const FoundPlace& first = best_first.front();
  const auto rival = std::ranges::find_if(best_first, [&](const FoundPlace& place) {
    return place.support >= config.rival_support * first.support &&
           is_elsewhere(place.T_world_camera, first.T_world_camera, config);
  });
  return rival == best_first.end() ? nullptr : &*rival;
}

}  // namespace

bool is_elsewhere(const SE3& T_world_a, const SE3& T_world_b, const config::RelocalisationConfig& config) {
  const double apart_m = (T_world_a.translation - T_world_b.translation).norm();
  return apart_m > config.rival_separation * config.keyframe_distance_m ||
         rotation_angle_rad(T_world_a.rotation, T_world_b.rotation) >
             config.rival_separation * radians(config.keyframe_angle_deg);
}

void RivalPlaces::observe(std::int64_t timestamp_ns, std::span<const FoundPlace> best_first) {
  if (best_first.empty()) return;
  const FoundPlace* rival = rival_of_first(best_first, config_);
  if (rival == nullptr) return;
  timestamp_ns_ = timestamp_ns;
  a_world_m_ = best_first.front().T_world_camera.translation;
  b_world_m_ = rival->T_world_camera.translation;
  // Of a room that looks alike on two sides, only the direction differs.
  apart_m_ =
      std::max((a_world_m_ - b_world_m_).norm(), config_.rival_separation * config_.keyframe_distance_m);
}

bool RivalPlaces::repeats_near(std::int64_t timestamp_ns, const Vector3d& position_m) const {
  if (apart_m_ == 0 || seconds_between(timestamp_ns_, timestamp_ns) > config_.rivals_within_s) return false;
  return std::min((position_m - a_world_m_).norm(), (position_m - b_world_m_).norm()) <= apart_m_;
}

bool RivalPlaces::is_only_one(std::int64_t timestamp_ns, std::span<const FoundPlace> allowed,
                              const PredictedPosition& predicted) const {
  if (rival_of_first(allowed, config_) != nullptr) return false;
  const Vector3d& position_m = allowed.front().T_world_camera.translation;
  if (!repeats_near(timestamp_ns, position_m)) return true;
  constexpr double kSigmas = 3;
  return std::max((position_m - predicted.world_m).norm(), kSigmas * predicted.sigma_m) < 0.5 * apart_m_;
}

}  // namespace fusebench::relocalisation
