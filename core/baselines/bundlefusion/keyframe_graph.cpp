#include "core/baselines/bundlefusion/keyframe_graph.hpp"

#include <algorithm>
#include <utility>

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr int kGraphSteps = 3;

/// Largest residual of the matches of a pair along a world axis (metres).
double largest_residual_m(const FramePair& pair, const Poses& poses) {
  double largest_m = 0;
  for (const auto& [point_a, point_b] : pair.rigid.points) {
    const Vector3d apart_m = *poses[pair.a] * point_a - *poses[pair.b] * point_b;
    largest_m = std::max(largest_m, apart_m.cwiseAbs().maxCoeff());
  }
  return largest_m;
}

}  // namespace

std::size_t KeyframeGraph::add(View keyframe, const std::optional<SE3>& T_world_guess) {
  const std::size_t added = keyframes_.size();
  keyframes_.push_back(std::move(keyframe));
  T_world_keyframe_.emplace_back();
  if (added == 0) {
    T_world_keyframe_[0] = T_world_guess.value_or(SE3{});
  } else if (place(added, T_world_guess)) {
    retry_one();
  }
  return added;
}

void KeyframeGraph::finish() {
  const auto placed = [&] {
    return std::ranges::count_if(T_world_keyframe_, [](const auto& pose) { return pose.has_value(); });
  };
  // Repeats while the number of placed keyframes grows. A newly placed one may displace another that
  // contradicts it, so an unbounded loop could alternate.
  for (auto before = placed() - 1; before < placed();) {
    before = placed();
    for (std::size_t k = 0; k < keyframes_.size(); ++k) {
      if (!T_world_keyframe_[k]) place(k, std::nullopt);
    }
  }
  std::vector<const DepthCloud*> clouds;
  for (const View& keyframe : keyframes_) clouds.push_back(&keyframe.cloud);
  const AdjustmentTerms terms{
      pairs_, clouds, {config_.sparse_weight, config_.final_dense_weight, config_.dense_far_m}};
  static_cast<void>(adjust_poses(T_world_keyframe_, terms, kGraphSteps, workers_));
}

bool KeyframeGraph::place(std::size_t keyframe, const std::optional<SE3>& T_world_guess) {
  auto found =
      workers_.map_chunks<std::optional<RigidMatches>>(keyframes_.size(), 1, [&](std::size_t k, std::size_t) {
        return T_world_keyframe_[k] ? match_views(keyframes_[k], keyframes_[keyframe]) : std::nullopt;
      });
  std::size_t most = 0;
  std::optional<SE3> T_world_matched;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k]) continue;
    if (found[k]->matches.size() > most) {
      most = found[k]->matches.size();
      T_world_matched = *T_world_keyframe_[k] * found[k]->T_a_b;
    }
    pairs_.push_back({k, keyframe, std::move(*found[k])});
  }
  if (!T_world_matched) return false;
  T_world_keyframe_[keyframe] = T_world_guess ? T_world_guess : T_world_matched;
  adjust();
  return T_world_keyframe_[keyframe].has_value();
}

/// Retries one unplaced keyframe in turn.
void KeyframeGraph::retry_one() {
  for (std::size_t tried = 0; tried < keyframes_.size(); ++tried) {
    retried_ = (retried_ + 1) % keyframes_.size();
    if (T_world_keyframe_[retried_]) continue;
    place(retried_, std::nullopt);
    return;
  }
}

void KeyframeGraph::adjust() {
  do {
    const AdjustmentTerms terms{pairs_, {}, {config_.sparse_weight, 0, 0}};
    if (!adjust_poses(T_world_keyframe_, terms, kGraphSteps, workers_)) return;
  } while (remove_worst_pair());
}

/// Removes the worst inconsistent pair. True if there was one.
bool KeyframeGraph::remove_worst_pair() {
  std::size_t worst = 0;
  double worst_m = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const double residual_m = largest_residual_m(pairs_[i], T_world_keyframe_);
    if (residual_m <= worst_m) continue;
    worst = i;
    worst_m = residual_m;
  }
  if (worst_m <= config_.max_residual_m) return false;
  pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(worst));
  drop_disconnected();
  return true;
}

/// Removes the poses and pairs of keyframes that are not connected with the first one.
void KeyframeGraph::drop_disconnected() {
  std::vector<bool> reached(keyframes_.size(), false);
  reached[0] = true;
  for (bool more = true; more;) {
    more = false;
    for (const FramePair& pair : pairs_) {
      if (reached[pair.a] == reached[pair.b]) continue;
      reached[pair.a] = reached[pair.b] = true;
      more = true;
    }
  }
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    if (!reached[k]) T_world_keyframe_[k].reset();
  }
  std::erase_if(pairs_, [&](const FramePair& pair) { return !reached[pair.a]; });
}

}  // namespace fusebench::baselines::bundlefusion
