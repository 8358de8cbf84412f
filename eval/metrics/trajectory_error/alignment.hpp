// What brings one trajectory closest to another: rotation, translation and scale from positions, or the first
// pose.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"

namespace fusebench::trajectory_error {

/// x -> image + shift + scale * R (x - centre) = scale * R x + t. The first form keeps the digits of
/// positions far from the origin. Poses are scaled in their translations, so that rotations stay rotations.
struct Similarity {
  double scale = 1;
  SE3 rigid;                           ///< T_reference_estimate without the scale: R, t
  Vector3d centre = Vector3d::Zero();  ///< one of the estimate's positions, and
  Vector3d image = Vector3d::Zero();   ///< the reference's position that belongs to it
  Vector3d shift = Vector3d::Zero();   ///< from `image` to the aligned `centre`

  [[nodiscard]] static Similarity mapping(double scale, const Quaterniond& rotation, const Vector3d& centre,
                                          const Vector3d& image, const Vector3d& shift) {
    return {scale, {rotation, image + (shift - rotation * Vector3d(scale * centre))}, centre, image, shift};
  }

  [[nodiscard]] Vector3d operator*(const Vector3d& point) const { return image + from_image(point); }
  [[nodiscard]] SE3 operator*(const SE3& pose) const {
    return {(rigid.rotation * pose.rotation).normalized(), *this * pose.translation};
  }

  /// The aligned point or pose, with its position relative to `image`.
  [[nodiscard]] Vector3d from_image(const Vector3d& point) const {
    return shift + rigid.rotation * Vector3d(scale * (point - centre));
  }
  [[nodiscard]] SE3 from_image(const SE3& pose) const {
    return {(rigid.rotation * pose.rotation).normalized(), from_image(pose.translation)};
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
  /// From a single pose se3 follows its orientation (as rpg_trajectory_evaluation does); otherwise positions
  /// that do not determine an alignment are an error. yaw always does.
  bool single_pose = false;
};

/// What moves `estimate` closest to `reference`; poses that belong together, as many on either side.
///
/// Errors data_corrupt: no poses, or motion that does not determine the alignment.
///   se3, sim3, scale   fewer than three positions, or positions of either side in a point or on a line: the
///                      rotation about the line is arbitrary, and so is the scale of a point
///   yaw                positions of either side on a vertical line; of a single pair of poses, z axes that
///                      are opposite within 0.1 degrees
///   origin, none       need no motion (origin with scale_origin: as scale)
///
/// With H = sum_i (g_i - g)(p_i - p)^T = U S V^T and d = det(U) det(V), a rotation about the worst axis has
/// the curvature c = s_2 + d s_3. It is refused if c <= 1e-9 s_1, or if c is not more than twice what the
/// rounding of the positions (coordinate_rounding()) can give. yaw: the same of hypot(H_xx + H_yy, H_yx -
/// H_xy).
[[nodiscard]] Result<Similarity> align(std::span<const SE3> reference, std::span<const SE3> estimate,
                                       const AlignmentRequest& request);

/// Least squares over positions: minimises sum |reference_i - (c R estimate_i + t)|^2. Errors as align().
[[nodiscard]] Result<Similarity> align_positions(std::span<const Vector3d> reference,
                                                 std::span<const Vector3d> estimate, bool with_scale);

}  // namespace fusebench::trajectory_error
