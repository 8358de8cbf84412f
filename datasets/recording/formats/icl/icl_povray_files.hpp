// The two text files that POV-Ray, as patched for ICL-NUIM, writes beside each image.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/base/image.hpp"
#include "core/base/io/fingerprint.hpp"
#include "core/base/types.hpp"

namespace fusebench::formats::icl {

/// A camera file: lines "cam_pos = [x, y, z]';" and so on, in the renderer's left-handed world with y up.
/// Units of the scene. The image's u axis runs along right, v against up.
struct PovrayCamera {
  Vector3d position = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitZ();  ///< its length and those of right and up give the focal lengths
  Vector3d up = Vector3d::UnitY();
  Vector3d right = Vector3d::UnitX();
};

/// Other lines of the file (cam_lookat, cam_sky, cam_fpoint, cam_angle) are left alone. Errors: data_missing;
/// data_corrupt (a missing or repeated vector, not three finite numbers, a zero axis, axes that are not
/// orthogonal within 1e-3 or not left-handed).
[[nodiscard]] Result<PovrayCamera> read_povray_camera(const std::filesystem::path& file);

/// T_world_camera with x right, y down, z forward, in the renderer's world with its y axis turned down (F of
/// icl_conventions.hpp), metres.
[[nodiscard]] SE3 pose_of(const PovrayCamera& camera, double units_per_metre);

/// A .depth file: one decimal number a pixel, row by row: the length of the ray from the camera's centre.
/// Returns z-depth in metres: length / sqrt(((u - cx) / fx)^2 + ((v - cy) / fy)^2 + 1). A ray of more than
/// 1000 m has hit nothing: 0. camera must have its size; opened: the bytes that the file must have. Errors:
/// data_missing, data_corrupt (changed, a number that is negative or none, too few or too many numbers).
[[nodiscard]] Result<DepthImage> read_povray_depth(
    const std::filesystem::path& file, const PinholeCamera& camera, double units_per_metre,
    const std::optional<io::ContentHash>& opened = std::nullopt);

}  // namespace fusebench::formats::icl
