// What both packings of ICL-NUIM have in common: the camera, left-handed poses, and time by frame number.
//
// The renderer's camera looks along z with x to the right and y UP, a left-handed frame; that is what the
// published fy = -480 says. The images themselves are stored top-down like any other, so a camera with y down
// has fy = +480, and poses are reflected: T_cv = F T F with F = diag(1, -1, 1). Both halves are needed. With
// one of them the trajectory looks plausible and is wrong, since no rigid alignment absorbs a reflection.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::icl {

/// Images of one rendered frame. The index is what names its pose.
struct IclFrame {
  std::int64_t index = 0;
  std::filesystem::path color_file;
  std::filesystem::path depth_file;
};

/// A frame's number as a file writes it: digits only, below 10^9; nothing otherwise.
[[nodiscard]] std::optional<std::int64_t> icl_index(std::string_view text);

/// The time given to a frame: index / rate, to the nearest nanosecond.
[[nodiscard]] std::int64_t icl_time_ns(std::int64_t index, double rate_hz);

/// F T F: a pose of the renderer as a pose of a camera with y down in a world with y down. Its own inverse.
[[nodiscard]] SE3 icl_reflect(const SE3& T_world_camera);

/// 640x480, 481.2, +480, 319.5, 239.5, no distortion (configs/recordings/icl_nuim.toml; the published fy is
/// -480).
[[nodiscard]] calibration::RigCalibration icl_calibration();

/// Fills recording.frames from frames in the order of their index, and notes how they got their time. Missing
/// indices between the first and the last are counted in a warning. frames must not be empty.
void add_icl_frames(const std::vector<IclFrame>& frames, const recording::ReadOptions& options,
                    recording::Recording& recording);

}  // namespace fusebench::formats::icl
