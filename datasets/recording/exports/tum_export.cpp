#include <fmt/format.h>

#include <iterator>
#include <string>
#include <vector>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/orbslam3_settings.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "datasets/recording/exports/sensor_tables.hpp"

namespace fusebench::exports {

namespace {

std::string color_name(const recording::FrameEntry& frame) {
  return fmt::format("rgb/{}.png", trajectory::stamp_text(frame.timestamp_ns));
}

std::string depth_name(const recording::FrameEntry& frame) {
  return fmt::format("depth/{}.png", trajectory::stamp_text(frame.depth_timestamp_ns));
}

/// Readers want rising stamps; files are named by them.
Result<void> check_depth_stamps(const recording::Recording& recording) {
  for (std::size_t k = 1; k < recording.frames.size(); ++k) {
    const std::int64_t before_ns = recording.frames[k - 1].depth_timestamp_ns;
    const std::int64_t stamp_ns = recording.frames[k].depth_timestamp_ns;
    if (stamp_ns > before_ns) continue;
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("'{}': the depth images of frames {} and {} have stamps {} and {} (they must rise)",
                    recording.name, k - 1, k, trajectory::stamp_text(before_ns),
                    trajectory::stamp_text(stamp_ns)),
        "leave these frames out with --frames A:B");
  }
  return {};
}

Result<void> write_lists(const recording::Recording& recording, const ExportPlace& place) {
  std::string color = "# color images\n# timestamp filename\n";
  std::string depth = "# depth maps\n# timestamp filename\n";
  std::string pairs;
  for (const recording::FrameEntry& frame : recording.frames) {
    const std::string color_row =
        fmt::format("{} {}", trajectory::stamp_text(frame.timestamp_ns), color_name(frame));
    const std::string depth_row =
        fmt::format("{} {}", trajectory::stamp_text(frame.depth_timestamp_ns), depth_name(frame));
    color += color_row + "\n";
    depth += depth_row + "\n";
    pairs += color_row + " " + depth_row + "\n";
  }
  return place.write({{"rgb.txt", color}, {"depth.txt", depth}, {"associations.txt", pairs}});
}

/// Of what is written: undistorted images of one camera, and an IMU on the images' clock.
calibration::RigCalibration calibration_of(const recording::Recording& recording) {
  calibration::RigCalibration rig;
  rig.color.pinhole = recording.rig.camera;
  rig.color.timing = recording.rig.timing;
  rig.color.ground_truth_offset_m = recording::ground_truth_offset_m(recording);
  rig.depth_units_per_metre = kTumDepth.units_per_metre;
  if (!recording.imu.empty())
    rig.imu = calibration::ImuCalibration{recording.rig.T_imu_camera, recording.rig.imu_noise};
  rig.source = recording.calibration ? recording.calibration->source : "";
  return rig;
}

Result<void> write_truth(const recording::Recording& recording, const ExportPlace& place) {
  if (recording.ground_truth.empty()) return {};
  const std::string label = recording.truth_label.empty() ? "" : fmt::format("# {}\n", recording.truth_label);
  return place.write({{"groundtruth.txt", label + trajectory::tum_text(recording.ground_truth)}});
}

std::string accelerometer_text(const recording::Recording& recording) {
  std::string text = "# timestamp ax ay az\n";
  for (const recording::AccelerometerSample& sample : recording.accelerometer) {
    const Vector3d& a = sample.specific_force_mps2;
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", trajectory::stamp_text(sample.timestamp_ns),
                   a.x(), a.y(), a.z());
  }
  return text;
}

Result<void> write_sensors(const recording::Recording& recording, const ExportPlace& place) {
  const std::string toml = calibration::to_toml(calibration_of(recording));
  if (auto readable = calibration::check_readable(toml, "calibration.toml"); !readable) return readable;
  std::vector<TextFile> files = {{"calibration.toml", toml},
                                 {"orbslam3.yaml", orbslam3_settings(recording, kTumDepth)}};
  if (!recording.accelerometer.empty())
    files.emplace_back("accelerometer.txt", accelerometer_text(recording));
  if (!recording.state_truth.empty())
    files.emplace_back("state_groundtruth.csv", state_table(recording.state_truth));
  if (!recording.imu.empty()) files.emplace_back("imu.csv", imu_table(recording.imu));
  return place.write(files);
}

}  // namespace

Result<WrittenExport> write_tum(const recording::Recording& recording, const ExportPlace& place) {
  if (const auto rise = check_depth_stamps(recording); !rise) return tl::unexpected(rise.error());
  if (const auto created = place.create_folders({"rgb", "depth"}); !created)
    return tl::unexpected(created.error());
  const auto counts = for_each_frame(recording, kTumDepth, [&](const QuantisedFrame& frame) -> Result<void> {
    if (auto written = images::write_png(place.file(color_name(frame.entry)), frame.color); !written)
      return written;
    return images::write_png(place.file(depth_name(frame.entry)), frame.depth);
  });
  if (!counts) return tl::unexpected(counts.error());
  for (const auto write : {write_lists, write_truth, write_sensors}) {
    if (const auto written = write(recording, place); !written) return tl::unexpected(written.error());
  }
  WrittenExport result{*counts, {"associations.txt", "orbslam3.yaml"}, {}};
  result.calibration = "orbslam3.yaml";
  result.notes.push_back(
      "ORB-SLAM3: rgbd_tum VOCABULARY orbslam3.yaml FOLDER associations.txt; its estimate is "
      "CameraTrajectory.txt");
  if (!recording.imu.empty())
    result.notes.push_back(
        "imu.csv is EuRoC's imu0/data.csv: rgbd_tum does not read it, nor IMU.* in the yaml");
  return result;
}

}  // namespace fusebench::exports
