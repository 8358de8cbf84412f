// Frames that have numbers and no times: rendered ones, and those of exports that keep no stamps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// Images of one frame. The number is what names its pose.
struct NumberedFrame {
  std::int64_t index = 0;
  std::filesystem::path color_file;
  std::filesystem::path depth_file;
};

/// A frame's number as a file writes it: digits only, below 10^9; nothing otherwise.
[[nodiscard]] std::optional<std::int64_t> frame_number(std::string_view text);

/// The rate of a recording without stamps: the options', else that which its files publish, else 30 Hz.
[[nodiscard]] double frame_rate_hz(const recording::ReadOptions& options,
                                   std::optional<double> published_hz = std::nullopt);

/// The time given to a frame: index / rate, to the nearest nanosecond.
[[nodiscard]] std::int64_t frame_time_ns(std::int64_t index, double rate_hz);

/// How files of frames are named: "frame-" and ".depth.png" around the number.
struct NumberedName {
  std::string_view before;
  std::string_view after;
};

using NumberedFiles = std::map<std::int64_t, std::filesystem::path>;

/// The files of a folder that have such a name (any of `names`), by number. Error data_corrupt: two of one
/// number.
[[nodiscard]] Result<NumberedFiles> numbered_files(const std::filesystem::path& folder,
                                                   std::span<const NumberedName> names);

/// Some file of the folder has such a name.
[[nodiscard]] bool has_numbered_file(const std::filesystem::path& folder, const NumberedName& name);

/// The frames that have both images; what has no partner is counted in a warning. Error data_missing: no
/// frame has both; expected: how its files are called, for the message.
[[nodiscard]] Result<std::vector<NumberedFrame>> pair_numbered(const NumberedFiles& color,
                                                               const NumberedFiles& depth,
                                                               std::string_view expected,
                                                               recording::Recording& recording);

/// Images of one kind: the files of a folder that have such a name.
struct NumberedImages {
  std::filesystem::path folder;
  std::span<const NumberedName> names;
};

/// The frames of both kinds. Errors: those of numbered_files() and pair_numbered().
[[nodiscard]] Result<std::vector<NumberedFrame>> list_numbered(const NumberedImages& color,
                                                               const NumberedImages& depth,
                                                               std::string_view expected,
                                                               recording::Recording& recording);

/// Poses T_world_camera of colour, each from a file with the 4x4 matrix of the depth camera's pose, at the
/// times of their numbers. Files of lost frames (numbers that are not finite) are counted in a warning.
/// Errors: those of numbered_files() and read_pose_matrix().
[[nodiscard]] Result<Trajectory> read_depth_camera_poses(const NumberedImages& files,
                                                         const calibration::RigCalibration& calibration,
                                                         double rate_hz, recording::Recording& recording);

/// Fills recording.frames from frames in the order of their index, and notes how they got their time.
/// Missing indices between the first and the last are counted in a warning. frames must not be empty.
/// reason: why there are no stamps, for the note ("7-Scenes has no stamps").
void add_numbered_frames(std::span<const NumberedFrame> frames, std::string_view reason, double rate_hz,
                         recording::Recording& recording);

}  // namespace fusebench::reading
