#include "core/baselines/elasticfusion/surfels/surfel_fusion.hpp"

#include <algorithm>
#include <cmath>

#include "core/baselines/elasticfusion/surfels/seen_surface.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_measure.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

constexpr float kAlongRay_m = 0.05F;
const float kLeastNormalCosine = std::cos(0.5F);
constexpr std::int32_t kFramesToBecomeStable = 20;
constexpr float kCopyDepth_m = 0.01F;
constexpr float kCopyReach = 1.4F;  // as a factor of the radius
constexpr int kFewestOriginals = 3;
constexpr std::size_t kFusedRowsAtOnce = 8;
constexpr std::size_t kSurfelsAtOnce = 16384;

bool is_measured(const LiveFrame& live, std::size_t pixel) {
  return live.raw_m.data[pixel] > 0 && live.normal.z.data[pixel] != 0;
}

}  // namespace

Surfel SurfelFusion::measured_surfel(const LiveFrame& live, int x, int y, const FusedPose& pose) const {
  const std::size_t pixel = live.raw_m.index(x, y);
  const float depth_m = live.raw_m.data[pixel];
  const Eigen::Vector3f normal_camera = live.normal.at(pixel);
  Surfel surfel;
  surfel.position =
      (pose.T_world_camera * camera_.back_project(x, y, static_cast<double>(depth_m))).cast<float>();
  surfel.normal = (pose.T_world_camera.rotation * normal_camera.cast<double>()).cast<float>();
  surfel.color = live.color.data[pixel];
  surfel.radius_m = radius_of(depth_m, normal_camera.z(), camera_);
  surfel.confidence = confidence_of(x, y, camera_, pose.motion_weight);
  surfel.created = pose.now;
  surfel.updated = pose.now;
  return surfel;
}

void SurfelFusion::start(const LiveFrame& live, const FusedPose& pose, SurfelMap& map) {
  for (int y = 0; y < camera_.height_px; ++y) {
    for (int x = 0; x < camera_.width_px; ++x) {
      if (is_measured(live, live.raw_m.index(x, y))) map.add(measured_surfel(live, x, y, pose));
    }
  }
}

void SurfelFusion::fuse(const LiveFrame& live, const FusedPose& pose, SurfelMap& map) {
  index_.build(map, camera_, pose.T_world_camera, {pose.now, window_, true, 0.0F}, workers_);
  update(live, pose, pose.now % 2, map);
  remove(pose, map);
}

/// Matches of the pixels of this phase, row by row.
std::vector<SurfelFusion::Match> SurfelFusion::find_matches(const LiveFrame& live, int phase) const {
  const int columns = (camera_.width_px - phase + 1) / 2, rows = (camera_.height_px - phase + 1) / 2;
  std::vector<Match> matches(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto surfels = index_.surfels();
  const auto match_of = [&](int x, int y) {
    Match match;
    const std::size_t pixel = live.raw_m.index(x, y);
    if (!is_measured(live, pixel)) return match;
    const float depth_m = live.raw_m.data[pixel];
    const Eigen::Vector3f ray = camera_.back_project(x, y, 1.0).cast<float>();
    const float length = ray.norm();
    const Eigen::Vector3f normal = live.normal.at(pixel);
    index_.around_pixel(x, y, [&](std::size_t number) {
      const CameraSurfel& surfel = surfels[number];
      if (std::abs(surfel.position.z() - depth_m) * length >= kAlongRay_m) return;
      if (surfel.normal.dot(normal) <= kLeastNormalCosine) return;
      const float distance_m = surfel.position.cross(ray).norm() / length;
      if (match.number < 0 || distance_m < match.distance_m)
        match = {static_cast<std::int32_t>(number), distance_m};
    });
    return match;
  };
  workers_.for_chunks(
      static_cast<std::size_t>(rows), kFusedRowsAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          for (int column = 0; column < columns; ++column)
            matches[row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)] =
                match_of(2 * column + phase, 2 * static_cast<int>(row) + phase);
        }
      });
  return matches;
}

void SurfelFusion::update(const LiveFrame& live, const FusedPose& pose, int phase, SurfelMap& map) {
  const std::vector<Match> matches = find_matches(live, phase);
  const auto surfels = index_.surfels();
  constexpr std::size_t kNoMatch = static_cast<std::size_t>(-1);
  std::vector<std::size_t> nearest(surfels.size(), kNoMatch);  // index of the match for each surfel
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].number < 0) continue;
    std::size_t& best = nearest[static_cast<std::size_t>(matches[i].number)];
    if (best == kNoMatch || matches[i].distance_m < matches[best].distance_m) best = i;
  }
  updated_now_.assign(surfels.size(), 0);
  const int columns = (camera_.width_px - phase + 1) / 2;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const int x = 2 * static_cast<int>(i % static_cast<std::size_t>(columns)) + phase;
    const int y = 2 * static_cast<int>(i / static_cast<std::size_t>(columns)) + phase;
    if (!is_measured(live, live.raw_m.index(x, y))) continue;
    if (matches[i].number < 0) {
      map.add(measured_surfel(live, x, y, pose));
      continue;
    }
    const auto number = static_cast<std::size_t>(matches[i].number);
    if (nearest[number] != i) continue;
    const std::size_t known = surfels[number].index;
    map.set(known, merged(map.at(known), measured_surfel(live, x, y, pose)));
    updated_now_[number] = 1;
  }
}

/// True if older, stable surfels are close behind it.
bool SurfelFusion::is_a_copy(std::size_t number, const SurfelMap& map) const {
  const auto surfels = index_.surfels();
  const CameraSurfel& surfel = surfels[number];
  int originals = 0;
  index_.around_place(camera_.project(surfel.position.cast<double>()), [&](std::size_t other) {
    const CameraSurfel& known = surfels[other];
    const Eigen::Vector3f apart = known.position - surfel.position;
    const bool is_close = (apart.z() > 0) & (apart.z() < kCopyDepth_m) &
                          (apart.head<2>().norm() < kCopyReach * surfel.radius_m);  // combined to one branch
    if (is_close && map.created[known.index] < map.created[surfel.index] &&
        map.confidence[known.index] > stable_confidence_)
      ++originals;
  });
  return originals >= kFewestOriginals;
}

void SurfelFusion::remove(const FusedPose& pose, SurfelMap& map) const {
  const auto surfels = index_.surfels();
  SeenSurface seen(camera_);
  for (std::size_t number = 0; number < surfels.size(); ++number) {
    const CameraSurfel& surfel = surfels[number];
    if (updated_now_[number] != 0 && map.confidence[surfel.index] > stable_confidence_)
      seen.add(surfel.position);
  }
  std::vector<std::uint8_t> flags(map.size(), 0);
  workers_.for_chunks(map.size(), kSurfelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      flags[i] = map.confidence[i] <= stable_confidence_ && pose.now - map.updated[i] > kFramesToBecomeStable;
  });
  workers_.for_chunks(surfels.size(), kSurfelsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t number = begin; number < end; ++number) {
      const bool goes = updated_now_[number] != 0
                            ? is_a_copy(number, map)
                            : seen.is_behind(surfels[number].position, surfels[number].normal);
      if (goes) flags[surfels[number].index] = 1;
    }
  });
  map.remove(flags);
}

}  // namespace fusebench::baselines::elasticfusion::surfels
