#include "core/baselines/bundlefusion/frame_pair.hpp"

#include "core/baselines/bundlefusion/dense_verification.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr DenseLimits kOfAPair{0.075, 0.02};

}  // namespace

std::optional<RigidMatches> match_views(const View& a, const View& b) {
  auto rigid = filter_by_motion(match_keypoints(a.keypoints, b.keypoints), a.keypoints, b.keypoints);
  if (!rigid || !covers_enough_area(rigid->points) || !fit_together(a.cloud, b.cloud, rigid->T_a_b, kOfAPair))
    return std::nullopt;
  return rigid;
}

}  // namespace fusebench::baselines::bundlefusion
