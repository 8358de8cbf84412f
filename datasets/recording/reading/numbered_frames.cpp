#include "datasets/recording/reading/numbered_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "datasets/recording/reading/text_matrix.hpp"

namespace fusebench::reading {

namespace {

std::optional<std::int64_t> number_in(std::string_view file_name, const NumberedName& name) {
  if (file_name.size() <= name.before.size() + name.after.size() || !file_name.starts_with(name.before) ||
      !file_name.ends_with(name.after))
    return std::nullopt;
  file_name.remove_prefix(name.before.size());
  file_name.remove_suffix(name.after.size());
  return frame_number(file_name);
}

}  // namespace

std::optional<std::int64_t> frame_number(std::string_view text) {
  const bool digits = !text.empty() && text.size() <= 9 &&
                      std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  std::int64_t index = 0;
  if (!digits || std::from_chars(text.data(), text.data() + text.size(), index).ec != std::errc())
    return std::nullopt;
  return index;
}

double frame_rate_hz(const recording::ReadOptions& options, std::optional<double> published_hz) {
  return options.frame_rate_hz.value_or(published_hz.value_or(recording::kUsualFrameRate_hz));
}

std::int64_t frame_time_ns(std::int64_t index, double rate_hz) {
  return std::llround(1e9 * static_cast<double>(index) / rate_hz);
}

Result<NumberedFiles> numbered_files(const std::filesystem::path& folder,
                                     std::span<const NumberedName> names) {
  NumberedFiles files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string file_name = entry.path().filename().string();
    for (const NumberedName& name : names) {
      const auto index = number_in(file_name, name);
      if (!index) continue;
      const auto [there, is_new] = files.emplace(*index, entry.path());
      if (is_new) continue;
      // The folder's order is the file system's; the message shall not depend on it.
      const std::string other_name = there->second.filename().string();
      const auto& [first, second] = std::minmax(other_name, file_name);
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: two files of frame {}: {} and {}", folder.string(), *index, first, second),
                  "a folder holds one recording");
    }
  }
  return files;
}

bool has_numbered_file(const std::filesystem::path& folder, const NumberedName& name) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (number_in(entry.path().filename().string(), name)) return true;
  }
  return false;
}

Result<std::vector<NumberedFrame>> pair_numbered(const NumberedFiles& color, const NumberedFiles& depth,
                                                 std::string_view expected, recording::Recording& recording) {
  std::vector<NumberedFrame> frames;
  for (const auto& [index, depth_file] : depth) {
    const auto color_file = color.find(index);
    if (color_file != color.end()) frames.push_back({index, color_file->second, depth_file});
  }
  if (frames.empty())
    return fail(ErrorCode::data_missing, fmt::format("{}: no frame has both {}", recording.name, expected));
  if (frames.size() < depth.size() || frames.size() < color.size()) {
    recording.warnings.push_back(fmt::format(
        "{}: {} of {} colour and {} of {} depth images have no partner and are not used", recording.name,
        color.size() - frames.size(), color.size(), depth.size() - frames.size(), depth.size()));
  }
  return frames;
}

Result<std::vector<NumberedFrame>> list_numbered(const NumberedImages& color, const NumberedImages& depth,
                                                 std::string_view expected, recording::Recording& recording) {
  const auto color_files = numbered_files(color.folder, color.names);
  if (!color_files) return tl::unexpected(color_files.error());
  const auto depth_files = numbered_files(depth.folder, depth.names);
  if (!depth_files) return tl::unexpected(depth_files.error());
  return pair_numbered(*color_files, *depth_files, expected, recording);
}

Result<Trajectory> read_depth_camera_poses(const NumberedImages& files,
                                           const calibration::RigCalibration& calibration, double rate_hz,
                                           recording::Recording& recording) {
  const auto found = numbered_files(files.folder, files.names);
  if (!found) return tl::unexpected(found.error());
  const SE3 T_depth_color = calibration.depth ? calibration.depth->T_color_depth.inverse() : SE3{};
  Trajectory poses;
  for (const auto& [index, file] : *found) {
    const auto T_world_depth = read_pose_matrix(file);
    if (!T_world_depth) return tl::unexpected(T_world_depth.error());
    if (*T_world_depth) poses.push_back({frame_time_ns(index, rate_hz), **T_world_depth * T_depth_color});
  }
  if (poses.size() < found->size())
    recording.warnings.push_back(fmt::format("{}: {} of {} poses are no numbers: these frames were lost",
                                             recording.name, found->size() - poses.size(), found->size()));
  return poses;
}

void add_numbered_frames(std::span<const NumberedFrame> frames, std::string_view reason, double rate_hz,
                         recording::Recording& recording) {
  for (const NumberedFrame& frame : frames) {
    const std::int64_t time_ns = frame_time_ns(frame.index, rate_hz);
    recording.frames.push_back({time_ns, time_ns, time_ns, time_ns, frame.color_file, frame.depth_file});
  }
  recording.notes.push_back(fmt::format("time: {}; frame k is taken to be at k / {} s", reason, rate_hz));
  const std::int64_t span = frames.back().index - frames.front().index + 1;
  const std::int64_t missing = span - static_cast<std::int64_t>(frames.size());
  if (missing > 0) {
    recording.warnings.push_back(fmt::format("{}: {} of the {} frames from {} to {} are not there",
                                             recording.name, missing, span, frames.front().index,
                                             frames.back().index));
  }
}

}  // namespace fusebench::reading
