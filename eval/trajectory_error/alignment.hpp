// What brings one trajectory closest to another: rotation, translation and scale from positions, or the first
// pose.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"

namespace fusebench::trajectory_error {

/// x -> scale * R x + t. Poses are scaled in their translations, so that rotations stay rotations.
struct Similarity {
  double scale = 1;
  SE3 rigid;  ///< T_reference_estimate without the scale

  [[nodiscard]] Vector3d operator*(const Vector3d& point) const { return rigid * Vector3d(scale * point); }
  [[nodiscard]] SE3 operator*(const SE3& pose) const {
    return rigid * SE3{pose.rotation, scale * pose.translation};
  }
};

/// What may move the estimate before it is compared.
enum class AlignmentMode {
  none,
  se3,     ///< rotation and translation from positions (Horn 1987; Umeyama 1991 with scale 1)
  sim3,    ///< and scale (Umeyama 1991)
  scale,   ///< Umeyama's scale alone, as `evo_ape -s`
  yaw,     ///< rotation about z and translation, for estimates that know gravity (Zhang & Scaramuzza 2018)
  origin,  ///< the first poses are laid onto each other
};
[[nodiscard]] std::string_view to_string(AlignmentMode mode);

struct AlignmentRequest {
  AlignmentMode mode = AlignmentMode::none;
  std::size_t first = 0;      ///< only so many associated poses tell it; 0: all
  bool scale_origin = false;  ///< with `origin`: Umeyama's scale first, as `evo_ape --align_origin -s`
  /// From a single pose se3 and yaw follow its orientation (as rpg_trajectory_evaluation does); otherwise
  /// positions that do not determine an alignment are an error.
  bool single_pose = false;
};

/// What moves `estimate` closest to `reference`; poses that belong together, as many on either side.
///
/// Errors data_corrupt: no poses; se3, sim3 or scale of fewer than three positions, or of positions of either
/// set on a line or in a point (the second singular value of their cross-covariance is below 1e-9 of the
/// first): the rotation about the line is then arbitrary, and a scale undefined.
[[nodiscard]] Result<Similarity> align(std::span<const SE3> reference, std::span<const SE3> estimate,
                                       const AlignmentRequest& request);

/// Least squares over positions: minimises sum |reference_i - (c R estimate_i + t)|^2. Errors as align().
[[nodiscard]] Result<Similarity> align_positions(std::span<const Vector3d> reference,
                                                 std::span<const Vector3d> estimate, bool with_scale);

}  // namespace fusebench::trajectory_error
