#include "core/baselines/bundlefusion/chunk.hpp"

#include <algorithm>
#include <utility>

#include "core/baselines/bundlefusion/dense_verification.hpp"
#include "core/baselines/bundlefusion/tracks.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr int kChunkSteps = 2;
constexpr double kMaxResidual_m = 0.02;  // largest residual of a match, with a share of exceptions
constexpr double kMaxShareBeyond = 0.05;
constexpr DenseLimits kOfADoubtfulChunk{0.05, 0.001};

}  // namespace

Chunk::Chunk(View first, const config::BundlefusionConfig& config, const Workers& workers)
    : config_(config), workers_(workers) {
  views_.push_back(std::move(first));
  T_first_camera_.emplace_back(SE3{});
}

bool Chunk::add(View view) {
  const std::size_t added = views_.size();
  views_.push_back(std::move(view));
  T_first_camera_.emplace_back();
  auto found = workers_.map_chunks<std::optional<RigidMatches>>(added, 1, [&](std::size_t k, std::size_t) {
    return T_first_camera_[k] ? match_views(views_[k], views_[added]) : std::nullopt;
  });
  for (std::size_t k = 0; k < added; ++k) {
    if (!found[k]) continue;
    T_first_camera_[added] = *T_first_camera_[k] * found[k]->T_a_b;  // by the latest such frame
    pairs_.push_back({k, added, std::move(*found[k])});
  }
  if (!T_first_camera_[added]) return false;
  const AdjustmentTerms terms{pairs_, {}, {config_.sparse_weight, 0, 0}};
  // If the equations are singular, the poses of the pairs remain.
  static_cast<void>(adjust_poses(T_first_camera_, terms, kChunkSteps, workers_));
  return true;
}

std::size_t Chunk::last_placed() const {
  std::size_t last = 0;
  for (std::size_t k = 0; k < T_first_camera_.size(); ++k) {
    if (T_first_camera_[k]) last = k;
  }
  return last;
}

bool Chunk::close() {
  if (pairs_.empty()) return false;
  const auto all_clouds = clouds();
  const AdjustmentTerms terms{
      pairs_, all_clouds, {config_.sparse_weight, config_.dense_weight, config_.dense_far_m}};
  if (!adjust_poses(T_first_camera_, terms, kChunkSteps, workers_)) return false;
  return matches_are_consistent() || depth_is_consistent();
}

std::vector<const DepthCloud*> Chunk::clouds() const {
  std::vector<const DepthCloud*> clouds;
  for (const View& view : views_) clouds.push_back(&view.cloud);
  return clouds;
}

bool Chunk::matches_are_consistent() const {
  double beyond = 0;
  double count = 0;
  for (const FramePair& pair : pairs_) {
    for (const auto& [point_a, point_b] : pair.rigid.points) {
      const Vector3d apart_m = *T_first_camera_[pair.a] * point_a - *T_first_camera_[pair.b] * point_b;
      if (apart_m.norm() > kMaxResidual_m) beyond += 1;
      count += 1;
    }
  }
  return beyond <= kMaxShareBeyond * count;
}

bool Chunk::depth_is_consistent() const {
  return std::ranges::all_of(pairs_, [&](const FramePair& pair) {
    const SE3 T_a_b = T_first_camera_[pair.a]->inverse() * *T_first_camera_[pair.b];
    return fit_together(views_[pair.a].cloud, views_[pair.b].cloud, T_a_b, kOfADoubtfulChunk);
  });
}

View Chunk::merged(const PinholeCamera& camera) const {
  std::vector<const Keypoints*> keypoints;
  for (const View& view : views_) keypoints.push_back(&view.keypoints);
  return {merge_tracks(keypoints, pairs_, T_first_camera_, camera), views_.front().cloud};
}

}  // namespace fusebench::baselines::bundlefusion
