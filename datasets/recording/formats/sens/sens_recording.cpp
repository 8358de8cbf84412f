#include "datasets/recording/formats/sens/sens_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "datasets/images/image_files.hpp"
#include "datasets/recording/formats/sens/sens_imu.hpp"
#include "datasets/recording/formats/sens/sens_stamps.hpp"
#include "datasets/recording/image_logs/file_part.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/reading/single_file.hpp"

namespace fusebench::formats::sens {

namespace {

namespace fs = std::filesystem;
using image_logs::SensColorCodec;
using image_logs::SensFrameParts;
using image_logs::SensHeader;
using image_logs::SensReader;

constexpr std::string_view kTruthLabel =
    "pseudo ground truth: BundleFusion's estimate in the .sens file, not independent";
constexpr double kSameTransform = 1e-9;

/// All but the images.
struct SensFile {
  fs::path path;
  SensHeader header;
  std::vector<SensFrameParts> frames;
  std::vector<image_logs::SensImuFrame> imu;
};

Result<SensFile> read_file(const fs::path& path) {
  auto reader = SensReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  SensFile file{path, reader->header(), {}, {}};
  while (true) {
    auto parts = reader->next_parts();
    if (!parts) return tl::unexpected(parts.error());
    if (!*parts) break;
    file.frames.push_back(std::move(**parts));
  }
  if (file.frames.empty())
    return fail(ErrorCode::data_corrupt, fmt::format("{}: has no frames", path.string()));
  auto imu = reader->imu_frames();
  if (!imu) return tl::unexpected(imu.error());
  file.imu = std::move(*imu);
  return file;
}

Result<calibration::RigCalibration> calibration_of(const SensFile& file) {
  const SensHeader& header = file.header;
  for (const PinholeCamera* camera : {&header.color, &header.depth}) {
    if (camera->fx_px > 0 && camera->fy_px > 0 && std::isfinite(camera->fx_px + camera->fy_px) &&
        std::isfinite(camera->cx_px + camera->cy_px))
      continue;
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: focal lengths {} and {} in its header", file.path.string(), camera->fx_px,
                            camera->fy_px),
                "put a calibration.toml beside the file");
  }
  if (!header.T_rig_color || !header.T_rig_depth)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: a camera's pose in its header is no rigid transform ({})",
                            file.path.string(), calibration::kRigidTransformRule),
                "put a calibration.toml beside the file");
  calibration::RigCalibration calibration;
  calibration.color.pinhole = header.color;
  calibration.color.timing = calibration::kUnknownTiming;
  calibration.source = "the header of the .sens file";
  const SE3 T_color_depth = header.T_rig_color->inverse() * *header.T_rig_depth;
  if (header.color != header.depth || pose_minus(T_color_depth, SE3{}).norm() > kSameTransform)
    calibration.depth = calibration::DepthCamera{header.depth, T_color_depth};
  return calibration;
}

/// The unit of the stamps; frames whose stamps cannot be used are left out. Nothing if there are no stamps
/// that can, with the reason.
ImageStamps take_stamps(SensFile& file, recording::Recording& recording) {
  std::vector<std::uint64_t> stamps;
  for (const SensFrameParts& frame : file.frames) stamps.push_back(frame.color_timestamp);
  ImageStamps read = image_stamps(stamps);
  if (!read.unit_ns || read.frames.size() == stamps.size()) return read;
  std::size_t first = 0;
  while (first < read.frames.size() && read.frames[first] == first) ++first;
  recording.warnings.push_back(fmt::format(
      "{}: {} of {} frames are not used, since their stamps do not rise with the others' (the first "
      "is frame {} with {})",
      file.path.string(), stamps.size() - read.frames.size(), stamps.size(), first, stamps[first]));
  std::vector<SensFrameParts> kept;
  for (const std::size_t frame : read.frames) kept.push_back(std::move(file.frames[frame]));
  file.frames = std::move(kept);
  return read;
}

/// A depth image is taken at the time of colour where its stamp is 0 (some writers stamp colour alone) or far
/// from colour's.
void add_frames(const SensFile& file, const ImageStamps& stamps, const recording::ReadOptions& options,
                recording::Recording& recording) {
  if (!stamps.unit_ns) {
    std::vector<reading::NumberedFrame> numbered(file.frames.size());
    for (std::size_t k = 0; k < numbered.size(); ++k) numbered[k].index = static_cast<std::int64_t>(k);
    reading::add_numbered_frames(numbered, stamps.reason, reading::frame_rate_hz(options), recording);
    return;
  }
  constexpr std::int64_t kFar_ns = 1'000'000'000;
  const std::uint64_t far = static_cast<std::uint64_t>(kFar_ns / *stamps.unit_ns);
  std::size_t odd = 0;
  for (const SensFrameParts& frame : file.frames) {
    const auto [least, most] = std::minmax(frame.color_timestamp, frame.depth_timestamp);
    const bool is_far = most - least > far;
    if (is_far && frame.depth_timestamp != 0) ++odd;
    const std::int64_t color_ns = static_cast<std::int64_t>(frame.color_timestamp) * *stamps.unit_ns;
    const std::int64_t depth_ns = is_far || frame.depth_timestamp == 0
                                      ? color_ns
                                      : static_cast<std::int64_t>(frame.depth_timestamp) * *stamps.unit_ns;
    recording.frames.push_back({color_ns, depth_ns, color_ns, depth_ns, {}, {}});
  }
  if (odd > 0)
    recording.warnings.push_back(fmt::format(
        "{}: {} depth stamps are more than 1 s from colour's and are not used", file.path.string(), odd));
}

/// Poses are the depth camera's.
Result<void> read_truth(const SensFile& file, const calibration::RigCalibration& calibration,
                        recording::Recording& recording) {
  const SE3 T_depth_color = calibration.depth ? calibration.depth->T_color_depth.inverse() : SE3{};
  Trajectory truth;
  for (std::size_t k = 0; k < file.frames.size(); ++k) {
    if (const auto& T_world_depth = file.frames[k].T_world_camera)
      truth.push_back({recording.frames[k].timestamp_ns, *T_world_depth * T_depth_color});
  }
  if (truth.empty()) return reading::read_ground_truth_beside(file.path.parent_path(), recording);
  reading::label_truth(kTruthLabel, recording);
  return reading::set_ground_truth(recording, std::move(truth), file.path);
}

Result<ColorImage> plain_color(const reading::StoredImage& image, const PinholeCamera& camera) {
  ColorImage color(camera.width_px, camera.height_px);
  if (image.bytes.size() != 3 * color.data.size())
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {} bytes are not those of {}x{} pixels", image.name,
                                                     image.bytes.size(), camera.width_px, camera.height_px));
  for (std::size_t i = 0; i < color.data.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) color.data[i][c] = static_cast<std::uint8_t>(image.bytes[3 * i + c]);
  }
  return color;
}

reading::StoredImages images_of(const std::shared_ptr<const SensFile>& file, double units_per_metre) {
  const auto part = [file](std::string_view what, std::size_t frame, std::uint64_t position,
                           std::uint64_t count) -> Result<reading::StoredImage> {
    auto bytes = image_logs::bytes_of_file(file->path, position, count);
    if (!bytes) return tl::unexpected(bytes.error());
    return reading::StoredImage{fmt::format("{}: {} of frame {}", file->path.string(), what, frame),
                                std::move(*bytes)};
  };
  reading::StoredImages images;
  images.color = [file, part](std::size_t k) {
    return part("colour", k, file->frames[k].color_position, file->frames[k].color_bytes);
  };
  images.depth = [file, part](std::size_t k) {
    return part("depth", k, file->frames[k].depth_position, file->frames[k].depth_bytes);
  };
  images.decode_color = [file](const reading::StoredImage& image) {
    return file->header.color_codec == SensColorCodec::plain ? plain_color(image, file->header.color)
                                                             : images::decode_color(image.name, image.bytes);
  };
  images.decode_depth = [file, units_per_metre](const reading::StoredImage& image) -> Result<DepthImage> {
    const auto values = image_logs::sens_depth(file->header, image.bytes);
    if (values) return reading::depth_in_metres(*values, units_per_metre);
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: damaged, or not of {}x{} pixels", image.name, file->header.depth.width_px,
                            file->header.depth.height_px));
  };
  return images;
}

}  // namespace

bool is_sens(const fs::path& place) { return reading::file_with_ending(place, ".sens").has_value(); }

Result<recording::Recording> open_sens(const fs::path& place, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(place, "sens");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const auto path = reading::file_with_ending(place, ".sens");
  if (!path)
    return fail(ErrorCode::data_missing, fmt::format("{}: not one .sens file", place.string()),
                "name the file, or a folder that holds one");
  recording.name = path->stem().string();
  auto read = read_file(*path);
  if (!read) return tl::unexpected(read.error());
  const ImageStamps stamps = take_stamps(*read, recording);
  const auto file = std::make_shared<const SensFile>(std::move(*read));
  if (file->header.depth_codec == image_logs::SensDepthCodec::occipital)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: depth is in the occipital codec, which is not read", path->string()),
                "write it again with zlib depth, as ScanNet's tools do");
  const fs::path folder = path->parent_path();
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return calibration_of(*file); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  add_frames(*file, stamps, options, recording);
  if (const auto truth = read_truth(*file, *calibration, recording); !truth)
    return tl::unexpected(truth.error());
  if (file->imu.empty() || !stamps.unit_ns) {
    if (!file->imu.empty())
      recording.warnings.push_back(fmt::format("{}: {} inertial frames are not used: {}", path->string(),
                                               file->imu.size(), stamps.reason));
    if (const auto imu = reading::read_imu_beside(folder, recording); !imu)
      return tl::unexpected(imu.error());
  } else if (const auto imu = take_imu_frames(*path, file->imu, *stamps.unit_ns, recording); !imu) {
    return tl::unexpected(imu.error());
  }
  const double units = reading::settled_depth_units(*calibration, file->header.depth_units_per_metre);
  const auto attached = reading::attach_images(recording, *calibration, fmt::format("sens {}", units),
                                               reading::stored_images(images_of(file, units)));
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench::formats::sens
