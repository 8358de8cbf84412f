#include "datasets/zr300.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/trajectory_file.hpp"
#include "datasets/image_pairs.hpp"
#include "datasets/image_recording.hpp"
#include "datasets/infinitam_calibration.hpp"
#include "datasets/recording_catalogue.hpp"
#include "datasets/side_files.hpp"
#include "datasets/zr300_lists.hpp"

namespace fusebench {

namespace fs = std::filesystem;

namespace {

constexpr double kUnitsPerMetre = 1000;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// calib.txt has no distortion. FMDataset's lens has some; another device is recognised by its focal length.
void complete_distortion(const RigCalibration& fmdataset, RigCalibration& calibration) {
  constexpr double kSameLens = 0.01;
  const double fx_px = fmdataset.color.pinhole.fx_px;
  const bool same = std::abs(calibration.color.pinhole.fx_px - fx_px) < kSameLens * fx_px;
  if (same) calibration.color.distortion = fmdataset.color.distortion;
  calibration.source +=
      same ? ", with the published distortion of FMDataset's ZR300" : ", without distortion";
}

Result<RigCalibration> read_calib_txt(const fs::path& file, const RigCalibration& fmdataset) {
  auto calibration = read_infinitam_calibration(file);
  if (!calibration) return calibration;
  // The colour camera of a ZR300 is right of the depth camera, so the latter has a negative x in it.
  if (calibration->depth->T_color_depth.translation.x() > 0) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: its third block puts the colour camera left of the depth camera, where no "
                            "ZR300 has it",
                            file.string()),
                "the block must map depth to colour, as FMDataset's does; InfiniTAM's maps colour to depth");
  }
  calibration->source = file.string();
  complete_distortion(fmdataset, *calibration);
  return calibration;
}

Result<RigCalibration> known_calibration(const fs::path& folder) {
  auto fmdataset = catalogue_calibration("zr300_fmdataset");
  if (!fmdataset) return fmdataset;
  // One file serves all sequences of a scene. A trailing slash would make the folder its own parent.
  const fs::path whole = fs::absolute(folder / "x").lexically_normal().parent_path();
  for (const fs::path& place : {whole, whole.parent_path()}) {
    if (is_there(place / "calib.txt")) return read_calib_txt(place / "calib.txt", *fmdataset);
  }
  fmdataset->source = fmt::format("published for FMDataset's ZR300 ({})", fmdataset->source);
  return fmdataset;
}

/// The images decide what is used: an IMU of another time is an error, one that ends early a warning.
Result<void> check_imu_overlap(const fs::path& folder, Recording& recording) {
  if (recording.imu.empty()) return {};
  const std::int64_t first_ns = recording.imu.front().timestamp_ns;
  const std::int64_t last_ns = recording.imu.back().timestamp_ns;
  const std::int64_t begin_ns = recording.frames.front().timestamp_ns;
  const std::int64_t end_ns = recording.frames.back().timestamp_ns;
  if (first_ns > end_ns || last_ns < begin_ns) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: inertial samples (times {} to {}) do not overlap the images (times {} to {})",
                    folder.string(), stamp_text(first_ns), stamp_text(last_ns), stamp_text(begin_ns),
                    stamp_text(end_ns)),
        "both must be of one recording and clock");
  }
  const auto outside = std::ranges::count_if(recording.frames, [&](const FrameEntry& frame) {
    return frame.timestamp_ns < first_ns || frame.timestamp_ns > last_ns;
  });
  if (outside > 0) {
    recording.warnings.push_back(
        fmt::format("{}: {} of {} frames are before the first or after the last "
                    "inertial sample",
                    folder.string(), outside, recording.frames.size()));
  }
  return {};
}

Result<void> read_imu(const fs::path& folder, Recording& recording) {
  const auto read = [&] {
    if (is_there(folder / "IMU.txt")) return read_zr300_imu(folder, recording);
    if (is_there(folder / "GYRO.txt")) return read_zr300_gyro_and_accel(folder, recording);
    return read_imu_beside(folder, recording);
  };
  const Result<void> done = read();
  return done ? check_imu_overlap(folder, recording) : done;
}

using ImageLists = Result<Zr300Images> (*)(const fs::path& folder, bool filtered, Recording& recording);

Result<Recording> open_with(ImageLists read_lists, const fs::path& folder, const ReadOptions& options,
                            Recording recording) {
  if (const auto valid = check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = choose_calibration(
      folder, options, [&] { return known_calibration(folder); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto images = read_lists(folder, options.filtered_depth, recording);
  if (!images) return tl::unexpected(images.error());
  const auto paired =
      pair_images({"colour images", images->color}, {"depth images", images->depth}, options, recording);
  if (!paired) return tl::unexpected(paired.error());
  if (const auto read = read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = read_imu(folder, recording); !read) return tl::unexpected(read.error());
  const double units = calibration->depth_units_per_metre.value_or(kUnitsPerMetre);
  const auto attached =
      attach_images(recording, {std::move(*calibration), png_depth(units), fmt::format("png {}", units)});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace

Result<Recording> open_zr300(const fs::path& folder, const ReadOptions& options) {
  return open_with(read_zr300_timestamps, folder, options, named_recording(folder, "zr300"));
}

Result<Recording> open_zr300_raw(const fs::path& folder, const ReadOptions& options) {
  return open_with(read_zr300_image_lists, folder, options, named_recording(folder, "zr300_raw"));
}

}  // namespace fusebench
