#include "eval/reference_clock/offset_search.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::reference_clock {

namespace {

constexpr std::int64_t kStep_ns = 20'000'000;
constexpr std::size_t kMostCompared = 400;
constexpr std::size_t kFewestCompared = 30;

/// Weights that bound the influence of jumps of the estimate to that of a motion three times the median.
std::vector<double> bounded_weights(std::span<const MotionPair> pairs, const MotionSigmas& sigmas) {
  constexpr double kLarge = 3;
  std::vector<double> sizes;
  for (const MotionPair& pair : pairs) {
    sizes.push_back(std::hypot(so3_log(pair.estimated.rotation).norm() / sigmas.rotation_rad,
                               pair.estimated.translation.norm() / sigmas.translation_m));
  }
  std::vector<double> sorted = sizes;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double large = kLarge * *middle;
  for (double& size : sizes) size = size <= large ? 1.0 : large / size;
  return sizes;
}

OffsetCandidate candidate_at(double offset_s, std::span<const MotionPair> pairs) {
  const MotionSigmas sigmas;
  OffsetCandidate candidate{offset_s, 0, rough_transform(pairs, bounded_weights(pairs, sigmas), sigmas)};
  for (const auto& [reference, estimated] : pairs) {
    const Vector6d residual = pose_minus(reference, candidate.transform(estimated));
    candidate.misfit += std::hypot(residual.head<3>().norm() / sigmas.rotation_rad,
                                   residual.tail<3>().norm() / sigmas.translation_m);
  }
  candidate.misfit /= static_cast<double>(pairs.size());
  return candidate;
}

}  // namespace

std::vector<OffsetCandidate> offset_profile(const Trajectory& reference,
                                            std::span<const EstimatedMotion> motions) {
  const std::size_t stride = std::max<std::size_t>(1, (motions.size() + kMostCompared - 1) / kMostCompared);
  const auto steps = static_cast<std::int64_t>(std::llround(1e9 * kLargestOffset_s)) / kStep_ns;
  std::vector<OffsetCandidate> profile;
  std::vector<MotionPair> pairs;
  for (std::int64_t step = -steps; step <= steps; ++step) {
    const std::int64_t offset_ns = step * kStep_ns;
    pairs.clear();
    std::size_t compared = 0;
    for (std::size_t k = 0; k < motions.size(); k += stride, ++compared) {
      const EstimatedMotion& each = motions[k];
      const auto known = reference_motion(reference, each.begin_ns + offset_ns, each.end_ns + offset_ns);
      if (known) pairs.push_back({*known, each.motion});
    }
    if (pairs.size() < kFewestCompared || 2 * pairs.size() < compared) continue;
    profile.push_back(candidate_at(1e-9 * static_cast<double>(offset_ns), pairs));
  }
  return profile;
}

const OffsetCandidate& best_of(std::span<const OffsetCandidate> profile) {
  return *std::ranges::min_element(profile, {}, &OffsetCandidate::misfit);
}

std::optional<OffsetCandidate> ambiguous_candidate(const OffsetCandidate& best,
                                                   std::span<const OffsetCandidate> profile,
                                                   double duration_s) {
  constexpr double kApart_s = 0.1;
  constexpr double kSameMinimum_s = 1e-6;  // stamps are multiples of 20 ms
  constexpr double kRounding = 0.01;       // 0.1 mm and 0.1 mrad
  const double limit = (1 + 1.5 / std::sqrt(duration_s)) * (best.misfit + kRounding) - kRounding;
  std::optional<OffsetCandidate> ambiguous;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double misfit = profile[i].misfit;
    const bool local = (i == 0 || misfit <= profile[i - 1].misfit) &&
                       (i + 1 == profile.size() || misfit <= profile[i + 1].misfit);
    const bool apart = std::abs(profile[i].offset_s - best.offset_s) > kApart_s - kSameMinimum_s;
    if (local && apart && misfit < (ambiguous ? ambiguous->misfit : limit)) ambiguous = profile[i];
  }
  return ambiguous;
}

}  // namespace fusebench::reference_clock
