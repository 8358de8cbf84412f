#include "core/estimator/places/loops/place_search.hpp"

#include <algorithm>
#include <utility>

#include "core/base/geometry.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/estimator/places/smallest_first.hpp"

namespace fusebench::loops {

namespace {

/// Number of places that are at least loops.least_age_s older than the last one.
std::size_t count_of_old(std::span<const Place> places, const config::LoopsConfig& config) {
  const auto is_old = [&](const Place& place) {
    return seconds_between(place.timestamp_ns, places.back().timestamp_ns) >= config.least_age_s;
  };
  return static_cast<std::size_t>(std::ranges::partition_point(places, is_old) - places.begin());
}

}  // namespace

double dissimilarity(const Place& a, const Place& b) {
  return ferns::dissimilarity(a.appearance.code, b.appearance.code);
}

std::vector<std::size_t> similar_places(std::span<const Place> places, const config::LoopsConfig& config) {
  const std::size_t old = count_of_old(places, config);
  std::vector<std::pair<double, std::size_t>> similar;
  for (std::size_t known = 0; known < old; ++known) {
    const double different = dissimilarity(places[known], places.back());
    if (different <= config.max_dissimilarity) similar.emplace_back(different, known);
  }
  return places::smallest_first(std::move(similar), static_cast<std::size_t>(config.max_candidates));
}

std::vector<std::size_t> places_in_view(std::span<const Place> places,
                                        const std::function<SE3(std::size_t)>& T_world_camera,
                                        const config::LoopsConfig& config) {
  constexpr double kMostTurned_rad = radians(60);
  // of the distance to the surface: at this displacement half of the view overlaps
  constexpr double kViewShare = 0.5;
  const auto middle_of_view = [&](std::size_t place, const SE3& T) {
    return T * Vector3d(0, 0, places[place].view_depth_m);
  };
  const std::size_t query = places.size() - 1;
  const SE3 T_world_query = T_world_camera(query);
  const Vector3d middle = middle_of_view(query, T_world_query);
  const std::size_t old = count_of_old(places, config);
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t known = 0; known < old; ++known) {
    const SE3 T_world_known = T_world_camera(known);
    const double apart_m = (middle_of_view(known, T_world_known) - middle).norm();
    const double turned_rad = rotation_angle_rad(T_world_known.rotation, T_world_query.rotation);
    if (apart_m <= kViewShare * places[query].view_depth_m && turned_rad <= kMostTurned_rad)
      near.emplace_back(apart_m, known);
  }
  return places::smallest_first(std::move(near), static_cast<std::size_t>(config.max_path_candidates));
}

}  // namespace fusebench::loops
