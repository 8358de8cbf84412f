#include "datasets/recording/formats/zr300/zr300.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/calibration/infinitam_calibration.hpp"
#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/recording/formats/zr300/zr300_lists.hpp"
#include "datasets/recording/reading/image_pairs.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/side_files.hpp"

namespace fusebench::formats::zr300 {

namespace fs = std::filesystem;

namespace {

constexpr double kUnitsPerMetre = 1000;

/// calib.txt has no distortion. FMDataset's lens has some; another device, whose focal length may be near, is
/// recognised by its intrinsics as a whole.
void complete_distortion(const calibration::RigCalibration& fmdataset,
                         calibration::RigCalibration& calibration) {
  constexpr double kSameLens_px = 0.5;
  const PinholeCamera& published = fmdataset.color.pinhole;
  const PinholeCamera& given = calibration.color.pinhole;
  const bool same = std::abs(given.fx_px - published.fx_px) < kSameLens_px &&
                    std::abs(given.fy_px - published.fy_px) < kSameLens_px &&
                    std::abs(given.cx_px - published.cx_px) < kSameLens_px &&
                    std::abs(given.cy_px - published.cy_px) < kSameLens_px;
  if (same) calibration.color.distortion = fmdataset.color.distortion;
  calibration.source +=
      same ? ", with the published distortion of FMDataset's ZR300" : ", without distortion";
}

Result<calibration::RigCalibration> read_calib_txt(const fs::path& file,
                                                   const calibration::RigCalibration& fmdataset) {
  auto calibration = calibration::read_infinitam_calibration(file);
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

Result<calibration::RigCalibration> known_calibration(const fs::path& folder) {
  auto fmdataset = calibration::catalogue_calibration("zr300_fmdataset");
  if (!fmdataset) return fmdataset;
  // One file serves all sequences of a scene. A trailing slash would make the folder its own parent.
  const fs::path whole = fs::absolute(folder / "x").lexically_normal().parent_path();
  for (const fs::path& place : {whole, whole.parent_path()}) {
    if (io::is_named(place / "calib.txt")) return read_calib_txt(place / "calib.txt", *fmdataset);
  }
  fmdataset->source = fmt::format("published for FMDataset's ZR300 ({})", fmdataset->source);
  return fmdataset;
}

Result<void> read_imu(const fs::path& folder, recording::Recording& recording) {
  if (io::is_named(folder / "IMU.txt")) return read_zr300_imu(folder, recording);
  if (io::is_named(folder / "GYRO.txt")) return read_zr300_gyro_and_accel(folder, recording);
  return reading::read_imu_beside(folder, recording);
}

using ImageLists = Result<Zr300Images> (*)(const fs::path& folder, bool filtered,
                                           recording::Recording& recording);

Result<recording::Recording> open_with(ImageLists read_lists, const fs::path& folder,
                                       const recording::ReadOptions& options,
                                       recording::Recording recording) {
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return known_calibration(folder); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  const auto images = read_lists(folder, options.filtered_depth, recording);
  if (!images) return tl::unexpected(images.error());
  const auto paired = reading::pair_images({"colour images", images->color}, {"depth images", images->depth},
                                           options, recording);
  if (!paired) return tl::unexpected(paired.error());
  if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = read_imu(folder, recording); !read) return tl::unexpected(read.error());
  return reading::with_png_images(std::move(recording), std::move(*calibration), kUnitsPerMetre);
}

}  // namespace

Result<recording::Recording> open_zr300(const fs::path& folder, const recording::ReadOptions& options) {
  return open_with(read_zr300_timestamps, folder, options, recording::named_recording(folder, "zr300"));
}

Result<recording::Recording> open_zr300_raw(const fs::path& folder, const recording::ReadOptions& options) {
  return open_with(read_zr300_image_lists, folder, options, recording::named_recording(folder, "zr300_raw"));
}

}  // namespace fusebench::formats::zr300
