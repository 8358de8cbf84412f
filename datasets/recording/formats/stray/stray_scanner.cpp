#include "datasets/recording/formats/stray/stray_scanner.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "datasets/calibration/frame_cameras.hpp"
#include "datasets/calibration/scaled_camera.hpp"
#include "datasets/images/file_content.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/recording/formats/stray/stray_tables.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/numbered_frames.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/reading/text_matrix.hpp"

namespace fusebench::formats::stray {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 1000;
constexpr int kVideoWidth_px = 1920;  // of the camera that camera_matrix.csv is of
constexpr double kCentreTolerance = 0.1;
constexpr std::string_view kTruthLabel =
    "pseudo ground truth: ARKit's odometry of the same recording, not independent";
constexpr std::string_view kExtract =
    "extract the frames, in the folder, with: mkdir rgb && ffmpeg -noautorotate -i rgb.mp4 -vsync 0 "
    "-vf scale=640:-1 -start_number 0 rgb/%06d.png";
constexpr std::array<reading::NumberedName, 2> kColor = {{{"", ".png"}, {"", ".jpg"}}};
constexpr std::array<reading::NumberedName, 1> kDepth = {{{"", ".png"}}};

/// Images of all frames, by number.
struct StrayImages {
  reading::NumberedFiles color;
  reading::NumberedFiles depth;
  images::ImageSize color_size;
  images::ImageSize depth_size;
};

Result<StrayImages> list_images(const fs::path& folder) {
  if (!io::is_named(folder / "rgb"))
    return fail(ErrorCode::data_missing,
                fmt::format("{}: videos are not decoded, and the folder rgb of its frames is not there",
                            (folder / "rgb.mp4").string()),
                std::string(kExtract));
  const auto color = reading::numbered_files(folder / "rgb", kColor);
  if (!color) return tl::unexpected(color.error());
  const auto depth = reading::numbered_files(folder / "depth", kDepth);
  if (!depth) return tl::unexpected(depth.error());
  if (color->empty() || depth->empty())
    return fail(ErrorCode::data_missing,
                fmt::format("{}: no images in {}", folder.string(), color->empty() ? "rgb" : "depth"),
                std::string(kExtract));
  // ffmpeg counts from 1 unless told otherwise, which would shift colour by a frame.
  if (depth->begin()->first == 0 && color->begin()->first == 1)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: colour is numbered from 1, but depth from 0, so they would be a frame apart",
                            folder.string()),
                std::string(kExtract));
  const auto color_size = images::read_image_size(color->begin()->second);
  if (!color_size) return tl::unexpected(color_size.error());
  const auto depth_size = images::read_depth16(depth->begin()->second);
  if (!depth_size) return tl::unexpected(depth_size.error());
  return StrayImages{*color, *depth, *color_size, {depth_size->width, depth_size->height}};
}

/// The one camera of all frames whose rows in odometry.csv have intrinsics; nothing if none has. A warning
/// says if they differ.
std::optional<PinholeCamera> camera_of_frames(const fs::path& folder, const std::vector<StrayFrame>& odometry,
                                              recording::Recording& recording) {
  std::vector<calibration::FrameCamera> cameras;
  for (const StrayFrame& frame : odometry) {
    if (frame.camera) cameras.push_back({frame.index, *frame.camera});
  }
  if (cameras.empty()) return std::nullopt;
  const calibration::CommonCamera common = calibration::common_camera(cameras);
  if (!common.change.empty())
    recording.warnings.push_back(fmt::format("{}: {}", (folder / "odometry.csv").string(), common.change));
  return common.camera;
}

/// The video's camera, scaled to the size of the extracted images: that of the frames, else that of
/// camera_matrix.csv, which is the last frame's.
Result<calibration::RigCalibration> published_calibration(const fs::path& folder,
                                                          const std::optional<PinholeCamera>& of_frames,
                                                          const StrayImages& images) {
  const fs::path file = folder / (of_frames ? "odometry.csv" : "camera_matrix.csv");
  auto camera = of_frames ? Result<PinholeCamera>(*of_frames) : reading::read_camera_matrix(file);
  if (!camera) return tl::unexpected(camera.error());
  const images::ImageSize size = images.color_size;
  const double aspect = static_cast<double>(size.height_px) / size.width_px;
  camera->width_px = kVideoWidth_px;
  camera->height_px = static_cast<int>(std::lround(kVideoWidth_px * aspect));
  const auto off_centre = [](double centre, int side) {
    return std::abs(centre / side - 0.5) > kCentreTolerance;
  };
  if (off_centre(camera->cx_px, camera->width_px) || off_centre(camera->cy_px, camera->height_px))
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: the centre ({}, {}) is not that of a video of {} pixels width whose images are "
                    "{}x{}",
                    file.string(), camera->cx_px, camera->cy_px, kVideoWidth_px, size.width_px,
                    size.height_px),
        "images must not be rotated (ffmpeg -noautorotate); else give --calibration");
  calibration::RigCalibration calibration;
  calibration.color.pinhole = calibration::scaled_camera(*camera, size.width_px, size.height_px);
  calibration.color.timing = calibration::kUnknownTiming;
  calibration.source = file.filename().string() + " of the recording, scaled to the images";
  return calibration;
}

/// Frames that have a time, both images and a pose.
Result<void> add_frames(const std::vector<StrayFrame>& odometry, const StrayImages& images,
                        recording::Recording& recording) {
  Trajectory truth;
  for (const StrayFrame& frame : odometry) {
    truth.push_back({frame.timestamp_ns, frame.T_world_camera});
    const auto color = images.color.find(frame.index);
    const auto depth = images.depth.find(frame.index);
    if (color == images.color.end() || depth == images.depth.end()) continue;
    const std::int64_t t = frame.timestamp_ns;
    recording.frames.push_back({t, t, t, t, color->second, depth->second});
  }
  if (recording.frames.empty())
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: no frame of odometry.csv has both rgb/<k> and depth/<k>", recording.name),
                std::string(kExtract));
  if (recording.frames.size() < odometry.size()) {
    recording.warnings.push_back(fmt::format("{}: {} of the {} frames of odometry.csv lack an image",
                                             recording.name, odometry.size() - recording.frames.size(),
                                             odometry.size()));
  }
  reading::label_truth(kTruthLabel, recording);
  return reading::set_ground_truth(recording, std::move(truth), "odometry.csv");
}

/// Depth without what the sensor calls uncertain.
class ConfidentDepth {
 public:
  static Result<ConfidentDepth> read(const fs::path& folder, const recording::Recording& recording) {
    ConfidentDepth confident;
    io::Fingerprint fingerprint;
    for (const recording::FrameEntry& frame : recording.frames) {
      const fs::path file = folder / "confidence" / frame.depth_file.filename();
      if (!io::is_named(file)) continue;
      if (const auto sized = images::check_image_bytes(file); !sized) return tl::unexpected(sized.error());
      const auto hash = fingerprint.add_file(file);
      if (!hash) return tl::unexpected(hash.error());
      confident.files_->emplace(frame.depth_file, Confidence{file, *hash});
    }
    confident.identity_ = fingerprint.hex();
    return confident;
  }

  [[nodiscard]] std::size_t count() const { return files_->size(); }
  [[nodiscard]] const std::string& identity() const { return identity_; }

  [[nodiscard]] reading::DepthReader reader(double units_per_metre) const {
    return [files = files_, read = reading::png_depth(units_per_metre)](
               const fs::path& file, const images::ImageSize& expected,
               const std::optional<io::ContentHash>& opened) -> Result<DepthImage> {
      auto depth_m = read(file, expected, opened);
      const auto found = files->find(file);
      if (!depth_m || found == files->end()) return depth_m;
      const Confidence& confidence = found->second;
      const images::ByteBuffer content = images::content_of(confidence.file);
      if (const auto same = images::check_unchanged(confidence.file, content.text(), confidence.opened);
          !same)
        return tl::unexpected(same.error());
      const auto levels = images::read_grey(confidence.file, expected);
      if (!levels) return tl::unexpected(levels.error());
      for (std::size_t i = 0; i < levels->data.size(); ++i)
        depth_m->data[i] = levels->data[i] == 0 ? 0.0F : depth_m->data[i];
      return depth_m;
    };
  }

 private:
  struct Confidence {
    fs::path file;
    io::ContentHash opened;
  };
  std::shared_ptr<std::map<fs::path, Confidence>> files_ = std::make_shared<std::map<fs::path, Confidence>>();
  std::string identity_;
};

}  // namespace

bool is_stray(const fs::path& folder) {
  return io::is_named(folder / "odometry.csv") && io::is_named(folder / "camera_matrix.csv");
}

Result<recording::Recording> open_stray(const fs::path& folder, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "stray");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const auto odometry = read_stray_odometry(folder / "odometry.csv", recording.warnings);
  if (!odometry) return tl::unexpected(odometry.error());
  const auto of_frames = camera_of_frames(folder, *odometry, recording);
  const auto images = list_images(folder);
  if (!images) return tl::unexpected(images.error());
  auto calibration = recording::choose_calibration(
      folder, options, [&] { return published_calibration(folder, of_frames, *images); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  reading::complete_depth_camera(*calibration, images->color_size, images->depth_size);
  if (const auto added = add_frames(*odometry, *images, recording); !added)
    return tl::unexpected(added.error());
  if (io::is_named(folder / "imu.csv")) {
    if (const auto read = read_stray_imu(folder / "imu.csv", recording); !read)
      return tl::unexpected(read.error());
  }
  const auto confident = ConfidentDepth::read(folder, recording);
  if (!confident) return tl::unexpected(confident.error());
  if (confident->count() > 0)
    recording.notes.emplace_back("depth: measurements of confidence 0 (low) are left out");
  const double units = reading::settled_depth_units(*calibration, kUnitsPerMetre);
  const auto attached = reading::attach_images(
      recording,
      {*calibration, confident->reader(units), fmt::format("stray {} {}", units, confident->identity())});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench::formats::stray
