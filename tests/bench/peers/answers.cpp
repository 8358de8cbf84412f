#include "tests/bench/peers/answers.hpp"

#include <cmath>
#include <optional>

#include "eval/metrics/statistics.hpp"
#include "tests/support/plain_field.hpp"

namespace fusebench::peers {

using namespace simd;
using namespace tsdf;
using namespace metrics;

namespace {

constexpr double kLeastShareRight = 0.9;

/// Distance to the zero level of the field, metres; nothing where nothing was observed. Between voxels where
/// all around are observed, else at the nearest one.
std::optional<double> distance_m(const TsdfVolume& field, const Vector3d& point_world) {
  const auto between_m = testing::PlainField(field).distance_m(point_world);
  if (between_m) return std::abs(*between_m);
  const Vector3d at_voxels = point_world / field.voxel_m();
  const VoxelIndex nearest = at_voxels.array().round().cast<int>();
  const auto voxel = testing::find_voxel(field, nearest);
  if (!voxel || voxel->weight <= 0.0F) return std::nullopt;
  return std::abs(static_cast<double>(voxel->distance_m));
}

}  // namespace

double MotionAnswer::share_right() const {
  return frames > 0 ? static_cast<double>(right) / static_cast<double>(frames) : 0.0;
}

void MotionJudge::add(const std::optional<SE3>& found, const SE3& truth) {
  ++counts_.frames;
  if (!found) return;
  ++counts_.found;
  const SE3 error = truth.inverse() * *found;
  const double rotation_deg = degrees(rotation_angle_rad(found->rotation, truth.rotation));
  translations_m_.push_back(error.translation.norm());
  rotations_deg_.push_back(rotation_deg);
  const bool right = translations_m_.back() <= MotionAnswer::kMostTranslation_m &&
                     rotation_deg <= MotionAnswer::kMostRotation_deg;
  if (right) ++counts_.right;
}

MotionAnswer MotionJudge::answer() const {
  MotionAnswer answer = counts_;
  answer.median_translation_m = statistics(translations_m_).median;
  answer.median_rotation_deg = statistics(rotations_deg_).median;
  return answer;
}

SurfaceAnswer judge_surface(const FusedSurface& surface, const TsdfVolume& ours) {
  // A hundred thousand of the points tell the share to a tenth of a percent.
  constexpr std::size_t kMostSamples = 100000;
  const std::size_t step = 1 + surface.points_world.size() / kMostSamples;
  std::size_t near = 0;
  std::size_t sampled = 0;
  for (std::size_t i = 0; i < surface.points_world.size(); i += step) {
    ++sampled;
    const auto off_m = distance_m(ours, surface.points_world[i]);
    if (off_m && *off_m <= SurfaceAnswer::kMostDistance_m) ++near;
  }
  return {surface.blocks, surface.block_side_voxels, surface.points_world.size(),
          sampled > 0 ? static_cast<double>(near) / static_cast<double>(sampled) : 0.0};
}

bool is_tracking(const MotionAnswer& answer, const MotionAnswer& standing_still) {
  return answer.share_right() >= kLeastShareRight &&
         (answer.median_rotation_deg < 0.5 * standing_still.median_rotation_deg ||
          answer.median_translation_m < 0.5 * standing_still.median_translation_m);
}

bool is_surface(const SurfaceAnswer& answer) {
  return answer.points > 0 && answer.share_near >= kLeastShareRight;
}

}  // namespace fusebench::peers
