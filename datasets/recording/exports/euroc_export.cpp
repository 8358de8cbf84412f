#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

#include "datasets/images/image_files.hpp"
#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/orbslam3_settings.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "datasets/recording/exports/sensor_tables.hpp"

namespace fusebench::exports {

namespace {

std::string image_name(const QuantisedFrame& frame) {
  return fmt::format("{}.png", frame.entry.timestamp_ns);
}

/// T_BS of a sensor.yaml.
std::string pose_yaml(const SE3& T_body_sensor) {
  return "T_BS:\n  cols: 4\n  rows: 4\n" + matrix_yaml(T_body_sensor);
}

SE3 T_body_camera(const recording::Recording& recording) {
  return recording.imu.empty() ? SE3{} : recording.rig.T_imu_camera;
}

std::string camera_yaml(const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  return "sensor_type: camera\ncomment: undistorted\n\n" + pose_yaml(T_body_camera(recording)) +
         fmt::format(
             "\nrate_hz: {:#}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
             "intrinsics: [{:#}, {:#}, {:#}, {:#}]  # fu, fv, cu, cv\n"
             "distortion_model: radial-tangential\ndistortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n",
             frame_rate_hz(recording), camera.width_px, camera.height_px, camera.fx_px, camera.fy_px,
             camera.cx_px, camera.cy_px);
}

std::string imu_yaml(const recording::Recording& recording) {
  const ImuNoise& noise = recording.rig.imu_noise;
  return "sensor_type: imu\ncomment: the body\n\n" + pose_yaml(SE3{}) +
         fmt::format(
             "\nrate_hz: {:#}\n"
             "gyroscope_noise_density: {:#}  # rad/s/sqrt(Hz)\n"
             "gyroscope_random_walk: {:#}  # rad/s^2/sqrt(Hz)\n"
             "accelerometer_noise_density: {:#}  # m/s^2/sqrt(Hz)\n"
             "accelerometer_random_walk: {:#}  # m/s^3/sqrt(Hz)\n",
             imu_rate_hz(recording), noise.gyroscope_radps_sqrthz, noise.gyroscope_bias_radps2_sqrthz,
             noise.accelerometer_mps2_sqrthz, noise.accelerometer_bias_mps3_sqrthz);
}

/// The body's poses in the ground truth's world.
Trajectory body_poses(const recording::Recording& recording) {
  const SE3 T_camera_body = T_body_camera(recording).inverse();
  Trajectory poses = recording.ground_truth;
  for (StampedPose& pose : poses) pose.T_world_camera = pose.T_world_camera * T_camera_body;
  return poses;
}

Result<void> write_cameras(const recording::Recording& recording, const ExportPlace& place) {
  std::string images = "#timestamp [ns],filename\n";
  std::string times;
  for (const recording::FrameEntry& frame : recording.frames) {
    fmt::format_to(std::back_inserter(images), "{0},{0}.png\n", frame.timestamp_ns);
    fmt::format_to(std::back_inserter(times), "{}\n", frame.timestamp_ns);
  }
  const std::string yaml = camera_yaml(recording);
  const std::string scale = fmt::format("depth_units_per_metre: {:#}\n", kEurocDepth.units_per_metre);
  return place.write({{"mav0/cam0/data.csv", images},
                      {"mav0/depth0/data.csv", images},
                      {"mav0/cam0/sensor.yaml", yaml},
                      {"mav0/depth0/sensor.yaml", yaml + scale},
                      {"times.txt", times}});
}

Result<void> write_imu(const recording::Recording& recording, const ExportPlace& place) {
  if (recording.imu.empty()) return {};
  if (auto created = place.create_folders({"mav0/imu0"}); !created) return created;
  return place.write(
      {{"mav0/imu0/sensor.yaml", imu_yaml(recording)}, {"mav0/imu0/data.csv", imu_table(recording.imu)}});
}

Result<void> write_truth(const recording::Recording& recording, const ExportPlace& place) {
  // True states are of the IMU, which is the body only if it is written.
  const bool has_states = !recording.state_truth.empty() && !recording.imu.empty();
  if (!has_states && recording.ground_truth.empty()) return {};
  const std::string folder = "mav0/state_groundtruth_estimate0";
  if (auto created = place.create_folders({folder}); !created) return created;
  return place.write({{folder + "/data.csv",
                       has_states ? state_table(recording.state_truth) : pose_table(body_poses(recording))}});
}

Result<void> write_settings(const recording::Recording& recording, const ExportPlace& place) {
  return place.write({{"orbslam3.yaml", orbslam3_settings(recording, kEurocDepth)}});
}

}  // namespace

Result<WrittenExport> write_euroc(const recording::Recording& recording, const ExportPlace& place) {
  if (const auto created = place.create_folders({"mav0/cam0/data", "mav0/depth0/data"}); !created)
    return tl::unexpected(created.error());
  const auto counts =
      for_each_frame(recording, kEurocDepth, [&](const QuantisedFrame& frame) -> Result<void> {
        const std::string name = image_name(frame);
        if (auto written = images::write_png(place.file("mav0/cam0/data/" + name), frame.grey); !written)
          return written;
        return images::write_png(place.file("mav0/depth0/data/" + name), frame.depth);
      });
  if (!counts) return tl::unexpected(counts.error());
  for (const auto write : {write_cameras, write_imu, write_truth, write_settings}) {
    if (const auto written = write(recording, place); !written) return tl::unexpected(written.error());
  }
  WrittenExport result{*counts, {"mav0", "times.txt", "orbslam3.yaml"}, {}};
  result.calibration = "orbslam3.yaml";
  result.notes = {"cam0 is grey, as EuRoC's; depth0 (mm, the stamps of cam0) is no part of EuRoC",
                  "ORB-SLAM3: mono_inertial_euroc VOCABULARY orbslam3.yaml FOLDER times.txt"};
  if (recording.imu.empty())
    result.notes.push_back("the recording has no IMU: there is no imu0, and poses are those of the camera");
  return result;
}

}  // namespace fusebench::exports
