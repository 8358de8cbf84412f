#include "datasets/inspection/warp_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"

namespace fusebench::inspection {

namespace {

constexpr std::array<std::size_t, 11> kSteps{1, 2, 3, 5, 8, 12, 20, 30, 45, 60, 90};
constexpr double kMaxTurn_rad = radians(25);
constexpr double kMaxBaseline = 0.3;  // of the depth
constexpr double kGoodTurn_rad = radians(10);
constexpr double kGoodBaseline = 0.1;
constexpr double kFastEnd_radps = radians(60);
constexpr std::size_t kCandidates = 600;
constexpr std::size_t kMinPoints = 100;

struct FramePose {
  std::optional<SE3> pose;
  double angular_radps = 0;
};

std::vector<FramePose> poses_of_frames(const recording::Recording& recording) {
  const std::int64_t gap_ns = truth_gap_ns(recording);
  std::vector<FramePose> result(recording.frames.size());
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k].pose =
        trajectory::interpolate_pose(recording.ground_truth, recording.frames[k].capture_ns, gap_ns);
  for (std::size_t k = 0; k < result.size(); ++k) {
    const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, result.size() - 1);
    const double dt_s =
        seconds_between(recording.frames[before].capture_ns, recording.frames[after].capture_ns);
    if (!result[before].pose || !result[after].pose || dt_s <= 0) continue;
    result[k].angular_radps =
        rotation_angle_rad(result[before].pose->rotation, result[after].pose->rotation) / dt_s;
  }
  return result;
}

struct ScoredPair {
  FramePair pair;
  double score = -1e9;
};

std::optional<double> score_of(const FramePose& from, const FramePose& to, double depth_m) {
  if (!from.pose || !to.pose) return std::nullopt;
  const double turn_rad = rotation_angle_rad(from.pose->rotation, to.pose->rotation);
  const double baseline = (from.pose->translation - to.pose->translation).norm() / depth_m;
  if (turn_rad > kMaxTurn_rad || baseline > kMaxBaseline) return std::nullopt;
  return std::min(1.0, baseline / kGoodBaseline) + 0.5 * std::min(1.0, turn_rad / kGoodTurn_rad) -
         0.5 * (from.angular_radps + to.angular_radps) / kFastEnd_radps;
}

ScoredPair best_from(const std::vector<FramePose>& poses, std::size_t from, double depth_m) {
  ScoredPair best;
  for (const std::size_t step : kSteps) {
    if (from + step >= poses.size()) break;
    const auto score = score_of(poses[from], poses[from + step], depth_m);
    if (score && *score > best.score) best = {{from, from + step}, *score};
  }
  return best;
}

}  // namespace

std::vector<FramePair> choose_pairs(const recording::Recording& recording, double depth_m,
                                    std::size_t count) {
  const std::vector<FramePose> poses = poses_of_frames(recording);
  const std::size_t stride = std::max<std::size_t>(1, poses.size() / kCandidates);
  std::vector<ScoredPair> best(std::max<std::size_t>(1, std::min(count, poses.size())));
  for (std::size_t from = 0; from + 1 < poses.size(); from += stride) {
    const ScoredPair candidate = best_from(poses, from, depth_m);
    ScoredPair& slot = best[from * best.size() / poses.size()];
    if (candidate.score > slot.score) slot = candidate;
  }
  std::vector<FramePair> result;
  for (const ScoredPair& scored : best) {
    if (scored.pair.to > scored.pair.from) result.push_back(scored.pair);
  }
  return result;
}

std::vector<measures::WarpPair> load_pairs(const recording::Recording& recording,
                                           const std::vector<FramePair>& pairs, const Workers& workers) {
  auto loaded = workers.map_chunks<std::optional<measures::WarpPair>>(
      pairs.size(), 1, [&](std::size_t i, std::size_t) -> std::optional<measures::WarpPair> {
        const auto from = recording.load_frame(pairs[i].from);
        auto to = recording.load_frame(pairs[i].to);
        if (!from || !to) return std::nullopt;
        return measures::make_warp_pair(pairs[i].from, pairs[i].to, *from, std::move(*to));
      });
  std::vector<measures::WarpPair> result;
  for (auto& pair : loaded) {
    if (pair && pair->points.size() >= kMinPoints) result.push_back(std::move(*pair));
  }
  return result;
}

}  // namespace fusebench::inspection
