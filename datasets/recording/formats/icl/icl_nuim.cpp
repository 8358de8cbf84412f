#include "datasets/recording/formats/icl/icl_nuim.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "datasets/recording/formats/icl/icl_povray.hpp"
#include "datasets/recording/reading/associated_row.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::icl {

namespace {

constexpr double kUnitsPerMetre = 5000;
constexpr std::size_t kFramesWithoutPose = 1;  // the trajectories begin at frame 1
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// The number in an image's name, where the name is one.
std::optional<std::int64_t> index_in_name(const std::filesystem::path& file) {
  return reading::frame_number(file.stem().string());
}

std::vector<std::filesystem::path> truth_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().filename().string().ends_with(".gt.freiburg")) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

bool counts_frames(const reading::AssociatedRow& row) {
  const auto color = reading::frame_number(row.color_stamp);
  const auto depth = reading::frame_number(row.depth_stamp);
  return color && depth && index_in_name(row.color_file) == color && index_in_name(row.depth_file) == depth;
}

bool is_tum_compatible(const std::filesystem::path& folder) {
  const std::filesystem::path list = folder / "associations.txt";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(list, ignored)) return false;
  if (!truth_files(folder).empty()) return true;
  const auto row = reading::first_associated_row(list);
  return row && counts_frames(*row);
}

Result<reading::NumberedFrame> frame_of(const io::TextTable& table, const reading::AssociatedRow& row) {
  for (const std::string& stamp : {row.color_stamp, row.depth_stamp}) {
    if (!reading::frame_number(stamp)) {
      return table.fail_here(fmt::format("expected the number of a frame (0, 1, 2, ...), got '{}'", stamp),
                             "a list with times is not ICL-NUIM's; open it with --format tum");
    }
  }
  const std::int64_t index = *reading::frame_number(row.color_stamp);
  if (*reading::frame_number(row.depth_stamp) != index) {
    return table.fail_here(
        fmt::format("colour image {} is paired with depth image {}", row.color_stamp, row.depth_stamp),
        "rendered images belong together by their number");
  }
  for (const auto& file : {row.color_file, row.depth_file}) {
    if (index_in_name(file).value_or(index) != index) {
      return table.fail_here(fmt::format("image {} is listed as number {}", file.filename().string(), index),
                             "poses are matched by number, so the list and the names must agree");
    }
  }
  return reading::NumberedFrame{index, row.color_file, row.depth_file};
}

Result<std::vector<reading::NumberedFrame>> read_frames(const std::filesystem::path& folder,
                                                        std::vector<std::string>& warnings) {
  std::vector<reading::NumberedFrame> frames;
  const auto take = [&](const io::TextTable& table, const reading::AssociatedRow& row) -> Result<void> {
    const auto frame = frame_of(table, row);
    if (!frame) return tl::unexpected(frame.error());
    if (!frames.empty() && frame->index <= frames.back().index) {
      return table.fail_here(fmt::format("frame {} comes after frame {}; numbers must increase", frame->index,
                                         frames.back().index));
    }
    frames.push_back(*frame);
    return {};
  };
  if (const auto read = reading::for_each_associated_row(folder / "associations.txt", take, warnings); !read)
    return tl::unexpected(read.error());
  return frames;
}

/// The file that holds the poses; nothing if there is none.
Result<std::optional<std::filesystem::path>> truth_file(const std::filesystem::path& folder,
                                                        recording::Recording& recording) {
  const std::vector<std::filesystem::path> published = truth_files(folder);
  if (published.size() > 1) {
    std::vector<std::string> names;
    for (const auto& file : published) names.push_back(file.filename().string());
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: {} ground truth files: {}", folder.string(), names.size(), fmt::join(names, ", ")),
        "keep the one of this trajectory");
  }
  const std::filesystem::path beside = folder / "groundtruth.txt";
  const bool has_beside = io::is_named(beside);
  if (published.empty()) return has_beside ? std::optional(beside) : std::nullopt;
  if (has_beside) {
    recording.notes.push_back(fmt::format("ground truth: {} is used, groundtruth.txt is not",
                                          published.front().filename().string()));
  }
  return std::optional(published.front());
}

Result<void> read_truth(const std::filesystem::path& folder, const recording::ReadOptions& options,
                        recording::Recording& recording) {
  const auto file = truth_file(folder, recording);
  if (!file) return tl::unexpected(file.error());
  if (!*file) return {};
  auto poses =
      trajectory::read_tum_trajectory(**file, recording.warnings);  // whole seconds are frame numbers here
  if (!poses) return tl::unexpected(poses.error());
  for (StampedPose& pose : *poses) {
    if (pose.timestamp_ns < 0 || pose.timestamp_ns % kNanosecondsPerSecond != 0) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: pose {} has no whole frame number (0, 1, 2, ...)", (*file)->string(),
                              trajectory::stamp_text(pose.timestamp_ns)),
                  "the first column of an ICL-NUIM trajectory counts frames; it is not a time");
    }
    pose.timestamp_ns =
        reading::frame_time_ns(pose.timestamp_ns / kNanosecondsPerSecond, reading::frame_rate_hz(options));
    pose.T_world_camera = icl_reflect(pose.T_world_camera);
  }
  return reading::set_ground_truth(recording, std::move(*poses), **file, kFramesWithoutPose);
}

}  // namespace

bool is_icl_nuim(const std::filesystem::path& folder) {
  return is_tum_compatible(folder) || is_icl_povray(folder);
}

Result<recording::Recording> open_icl_nuim(const std::filesystem::path& folder,
                                           const recording::ReadOptions& options) {
  if (!is_tum_compatible(folder) && is_icl_povray(folder)) return open_icl_povray(folder, options);
  recording::Recording recording = recording::named_recording(folder, "icl");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [] { return Result<calibration::RigCalibration>(icl_calibration()); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto frames = read_frames(folder, recording.warnings);
  if (!frames) return tl::unexpected(frames.error());
  reading::add_numbered_frames(*frames, "ICL-NUIM has no stamps", reading::frame_rate_hz(options), recording);
  if (const auto read = read_truth(folder, options, recording); !read) return tl::unexpected(read.error());
  if (const auto read = reading::read_imu_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace fusebench::formats::icl
