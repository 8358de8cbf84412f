// What a contestant's time is worth: were its answers right?
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"
#include "tests/bench/peers/contestant.hpp"

namespace fusebench::peers {

/// Motions from frame to frame against the ground truth.
struct MotionAnswer {
  static constexpr double kMostTranslation_m = 0.05;
  static constexpr double kMostRotation_deg = 3;

  std::size_t frames = 0;  ///< with ground truth
  std::size_t found = 0;   ///< for which there was an answer
  std::size_t right = 0;   ///< within both limits
  double median_translation_m = 0;
  double median_rotation_deg = 0;

  [[nodiscard]] double share_right() const;
};

class MotionJudge {
 public:
  /// T_before_now of the camera: nothing found is a wrong answer.
  void add(const std::optional<SE3>& found, const SE3& truth);
  [[nodiscard]] MotionAnswer answer() const;

 private:
  MotionAnswer counts_;
  std::vector<double> translations_m_;
  std::vector<double> rotations_deg_;
};

/// A fused surface against ours.
struct SurfaceAnswer {
  static constexpr double kMostDistance_m = 0.02;

  std::size_t blocks = 0;
  int block_side_voxels = 0;
  std::size_t points = 0;
  double share_near = 0;  ///< of the points: within the limit of the zero level of our field
};
[[nodiscard]] SurfaceAnswer judge_surface(const FusedSurface& surface, const TsdfVolume& ours);

/// Whether a time is worth anything: nine tenths of the answers are right, and (a slow camera makes "no
/// motion" right as well) the median error of the rotation or of the translation is less than half of what
/// standing still would have.
[[nodiscard]] bool is_tracking(const MotionAnswer& answer, const MotionAnswer& standing_still);
/// The same of a surface: it has points, and nine tenths of them are near ours.
[[nodiscard]] bool is_surface(const SurfaceAnswer& answer);

}  // namespace fusebench::peers
