#include "datasets/tum_rgbd.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "core/association.hpp"
#include "core/fingerprint.hpp"
#include "core/trajectory.hpp"
#include "core/trajectory_file.hpp"
#include "datasets/camera_presets.hpp"
#include "datasets/image_files.hpp"
#include "datasets/regular_stamps.hpp"
#include "datasets/tum_lists.hpp"

namespace fusebench {

namespace {

// A truth that pauses for longer than this (ten samples) does not say what the camera did in between.
constexpr std::int64_t kMaxTruthGap_ns = 100'000'000;

std::string folder_name(const std::filesystem::path& folder) {
  const std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

Result<void> check_options(const TumOptions& options) {
  if (!(options.depth_factor > 0 && std::isfinite(options.depth_factor))) {
    return fail(ErrorCode::configuration,
                fmt::format("depth_factor = {} (allowed: above 0)", options.depth_factor));
  }
  if (!(options.max_difference_s > 0 && options.max_difference_s <= 1)) {
    return fail(ErrorCode::configuration,
                fmt::format("max_difference_s = {} (allowed: above 0, up to 1)", options.max_difference_s));
  }
  return {};
}

Result<CalibratedCamera> choose_camera(const TumOptions& options, const std::string& name) {
  if (options.camera) return *options.camera;
  if (const auto camera = camera_by_folder_name(name)) return *camera;
  std::vector<std::string_view> presets;
  for (const CameraPreset& preset : camera_presets()) presets.push_back(preset.name);
  return fail(ErrorCode::configuration,
              fmt::format("the folder's name '{}' does not tell which camera recorded it", name),
              fmt::format("choose with --camera {} or --camera fx,fy,cx,cy[,k1,k2,p1,p2,k3]",
                          fmt::join(presets, "|")));
}

std::vector<std::int64_t> stamps(std::span<const ListedImage> images) {
  std::vector<std::int64_t> result;
  result.reserve(images.size());
  for (const ListedImage& image : images) result.push_back(image.timestamp_ns);
  return result;
}

/// "1305031229.528748", for messages.
std::string seconds_text(std::int64_t time_ns) {
  const std::int64_t magnitude = std::abs(time_ns);
  return fmt::format("{}{}.{:06}", time_ns < 0 ? "-" : "", magnitude / 1'000'000'000,
                     magnitude % 1'000'000'000 / 1'000);
}

/// When the images of a list were taken. The jitter that was removed is told, since it changes what an IMU
/// predicts.
std::vector<std::int64_t> capture_times(std::string_view list, std::span<const ListedImage> images,
                                        const TumOptions& options, Recording& recording) {
  std::vector<std::int64_t> recorded = stamps(images);
  if (!options.regular_stamps) return recorded;
  auto regular = regular_stamps(recorded);
  if (!regular) return recorded;
  recording.notes.push_back(
      fmt::format("{}: stamps jitter by {:.1f} ms rms (at most {:.1f} ms) and were made regular", list,
                  1e3 * regular->jitter_rms_s, 1e3 * regular->jitter_max_s));
  return std::move(regular->capture_ns);
}

Result<void> pair_images(const std::filesystem::path& folder, const TumOptions& options,
                         Recording& recording) {
  const auto color = read_image_list(folder / "rgb.txt");
  if (!color) return tl::unexpected(color.error());
  const auto depth = read_image_list(folder / "depth.txt");
  if (!depth) return tl::unexpected(depth.error());
  const std::int64_t max_difference_ns = std::llround(1e9 * options.max_difference_s);
  const auto pairs = associate(stamps(*color), stamps(*depth), max_difference_ns);
  if (pairs.empty()) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: no colour image (times {} to {}) has a depth image (times {} to {}) within {} s",
                    folder.string(), seconds_text(color->front().timestamp_ns),
                    seconds_text(color->back().timestamp_ns), seconds_text(depth->front().timestamp_ns),
                    seconds_text(depth->back().timestamp_ns), options.max_difference_s),
        "rgb.txt and depth.txt must be of one recording and one clock");
  }
  const std::vector<std::int64_t> color_ns = capture_times("rgb.txt", *color, options, recording);
  const std::vector<std::int64_t> depth_ns = capture_times("depth.txt", *depth, options, recording);
  for (const AssociatedPair& pair : pairs) {
    const ListedImage& c = (*color)[pair.first];
    const ListedImage& d = (*depth)[pair.second];
    recording.frames.push_back(
        {c.timestamp_ns, d.timestamp_ns, color_ns[pair.first], depth_ns[pair.second], c.file, d.file});
  }
  if (pairs.size() < color->size() || pairs.size() < depth->size()) {
    recording.warnings.push_back(fmt::format(
        "{}: {} of {} colour and {} of {} depth images have no partner within {} s and are not used",
        folder.string(), color->size() - pairs.size(), color->size(), depth->size() - pairs.size(),
        depth->size(), options.max_difference_s));
  }
  return {};
}

Result<void> read_ground_truth(const std::filesystem::path& folder, Recording& recording) {
  const std::filesystem::path file = folder / "groundtruth.txt";
  if (!std::filesystem::exists(file)) return {};
  // The published truth of freiburg2_desk repeats a stamp; TUM's own scripts keep the last of such rows.
  auto truth = read_tum_trajectory(file, recording.warnings, Duplicates::last_in_order);
  if (!truth) return tl::unexpected(truth.error());
  const std::int64_t first_ns = recording.frames.front().timestamp_ns;
  const std::int64_t last_ns = recording.frames.back().timestamp_ns;
  if (truth->front().timestamp_ns > last_ns || truth->back().timestamp_ns < first_ns) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: ground truth (times {} to {}) does not overlap the images (times {} to {})",
                    file.string(), seconds_text(truth->front().timestamp_ns),
                    seconds_text(truth->back().timestamp_ns), seconds_text(first_ns), seconds_text(last_ns)),
        "the truth must be of the same recording and clock, in seconds");
  }
  const auto uncovered = std::ranges::count_if(recording.frames, [&](const FrameEntry& frame) {
    return !interpolate_pose(*truth, frame.timestamp_ns, kMaxTruthGap_ns);
  });
  if (uncovered > 0) {
    recording.warnings.push_back(
        fmt::format("{}: {} of {} frames have no ground truth around them within {} s", file.string(),
                    uncovered, recording.frames.size(), seconds_between(0, kMaxTruthGap_ns)));
  }
  recording.ground_truth = std::move(*truth);
  return {};
}

Result<void> read_accelerometer(const std::filesystem::path& folder, Recording& recording) {
  const std::filesystem::path file = folder / "accelerometer.txt";
  if (!std::filesystem::exists(file)) return {};
  auto samples = read_tum_accelerometer(file);
  if (!samples) return tl::unexpected(samples.error());
  recording.accelerometer = std::move(*samples);
  return {};
}

/// Everything that a frame needs after opening; shared by all copies of the recording.
struct TumImages {
  std::vector<FrameEntry> frames;
  Undistortion undistortion;
  double depth_factor = 0;

  [[nodiscard]] Result<RgbdFrame> load(std::size_t index) const {
    check(index < frames.size(), "the frame exists");
    const FrameEntry& entry = frames[index];
    const ImageSize size{undistortion.camera().width_px, undistortion.camera().height_px};
    const auto color = read_color(entry.color_file, size);
    if (!color) return tl::unexpected(color.error());
    const auto depth = read_depth16(entry.depth_file, size);
    if (!depth) return tl::unexpected(depth.error());
    RgbdFrame frame;
    frame.timestamp_ns = entry.timestamp_ns;
    frame.capture_offset_ns = entry.capture_ns - entry.timestamp_ns;
    frame.depth_offset_ns = entry.depth_capture_ns - entry.capture_ns;
    frame.color = undistortion.undistort_color(*color);
    frame.grey = to_grey(frame.color);
    const Image<std::uint16_t> values = undistortion.undistort_depth(*depth);
    frame.depth_m = DepthImage(size.width_px, size.height_px);
    std::ranges::transform(values.data, frame.depth_m.data.begin(),
                           [&](std::uint16_t value) { return static_cast<float>(value / depth_factor); });
    return frame;
  }
};

/// The camera with the images' size; a calibration of another size is an error.
Result<CalibratedCamera> camera_of_images(CalibratedCamera camera, const std::filesystem::path& first_image) {
  const auto size = read_image_size(first_image);
  if (!size) return tl::unexpected(size.error());
  PinholeCamera& pinhole = camera.pinhole;
  if (pinhole.width_px == 0) {
    pinhole.width_px = size->width_px;
    pinhole.height_px = size->height_px;
  }
  if (*size != ImageSize{pinhole.width_px, pinhole.height_px}) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: image of {}x{} pixels, but the camera's calibration is for {}x{}",
                            first_image.string(), size->width_px, size->height_px, pinhole.width_px,
                            pinhole.height_px),
                "give the intrinsics of these images: --camera fx,fy,cx,cy[,k1,k2,p1,p2,k3]");
  }
  return camera;
}

/// The values that are used, not the text around them: a comment or a line ending does not make another
/// recording.
Result<std::string> fingerprint_of(const Recording& recording, const CalibratedCamera& camera,
                                   double depth_factor) {
  Fingerprint fingerprint;
  const PinholeCamera& p = camera.pinhole;
  const BrownConrady& d = camera.distortion;
  const SensorTiming& timing = camera.timing;
  fingerprint.add(fmt::format("tum {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", p.width_px, p.height_px,
                              p.fx_px, p.fy_px, p.cx_px, p.cy_px, d.k1, d.k2, d.p1, d.p2, d.k3, depth_factor,
                              timing.color_readout_s, timing.depth_readout_s, timing.depth_delay_s));
  for (const StampedPose& pose : recording.ground_truth) {
    const Vector3d& t = pose.T_world_camera.translation;
    const Quaterniond& q = pose.T_world_camera.rotation;
    fingerprint.add(fmt::format("truth {} {} {} {} {} {} {} {}", pose.timestamp_ns, t.x(), t.y(), t.z(),
                                q.x(), q.y(), q.z(), q.w()));
  }
  for (const AccelerometerSample& sample : recording.accelerometer) {
    const Vector3d& f = sample.specific_force_mps2;
    fingerprint.add(fmt::format("accelerometer {} {} {} {}", sample.timestamp_ns, f.x(), f.y(), f.z()));
  }
  for (const FrameEntry& frame : recording.frames) {
    fingerprint.add(fmt::format("frame {} {} {} {}", frame.timestamp_ns, frame.depth_timestamp_ns,
                                frame.capture_ns, frame.depth_capture_ns));
    for (const auto& file : {frame.color_file, frame.depth_file}) {
      const Result<void> added = fingerprint.add_file(file);
      if (!added) return tl::unexpected(added.error());
    }
  }
  return fingerprint.hex();
}

}  // namespace

Result<Recording> open_tum_rgbd(const std::filesystem::path& folder, const TumOptions& options) {
  Recording recording;
  recording.name = folder_name(folder);
  recording.format = "tum";
  if (const auto valid = check_options(options); !valid) return tl::unexpected(valid.error());
  const auto chosen = choose_camera(options, recording.name);
  if (!chosen) return tl::unexpected(chosen.error());
  if (const auto paired = pair_images(folder, options, recording); !paired)
    return tl::unexpected(paired.error());
  if (const auto read = read_ground_truth(folder, recording); !read) return tl::unexpected(read.error());
  if (const auto read = read_accelerometer(folder, recording); !read) return tl::unexpected(read.error());
  const auto camera = camera_of_images(*chosen, recording.frames.front().color_file);
  if (!camera) return tl::unexpected(camera.error());
  const std::int64_t depth_delay_ns = std::llround(1e9 * camera->timing.depth_delay_s);
  for (FrameEntry& frame : recording.frames) frame.depth_capture_ns += depth_delay_ns;
  auto fingerprint = fingerprint_of(recording, *camera, options.depth_factor);
  if (!fingerprint) return tl::unexpected(fingerprint.error());
  recording.fingerprint = std::move(*fingerprint);
  recording.rig.camera = camera->pinhole;
  recording.rig.timing = camera->timing;
  const auto images = std::make_shared<const TumImages>(
      TumImages{recording.frames, Undistortion(*camera), options.depth_factor});
  recording.load_frame = [images](std::size_t frame) { return images->load(frame); };
  return recording;
}

}  // namespace fusebench
