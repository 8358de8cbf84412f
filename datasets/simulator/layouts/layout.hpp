// File layouts of simulated recordings: those of TUM RGB-D, of ICL-NUIM (TUM-compatible packing) and of the
// ZR300 recordings of FMDataset. Beside what the format itself has, every layout holds
//
//     calibration.toml         rig_calibration.hpp
//     state_groundtruth.csv    EuRoC's columns: position, attitude, velocity and biases of the IMU
//                              body, on the images' clock
//     scene.ply                the scene's mesh; the same world as the ground truth
//
// and, where the format has no place for them, imu.csv and groundtruth.txt (side_files.hpp). ICL-NUIM's
// ground truth (livingRoom0.gt.freiburg) is reflected as published, left-handed with y up, while scene.ply
// and state_groundtruth.csv are in the right-handed world with y down that the reader makes of it
// (icl_conventions.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/images/image_files.hpp"
#include "datasets/simulator/sensors/frame_timing.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"
#include "datasets/simulator/sensors/imu_sensor.hpp"

namespace fusebench::simulator::layouts {

enum class RecordingLayout { tum, icl, zr300 };
[[nodiscard]] std::string_view to_string(RecordingLayout layout);

/// Everything of a simulated recording but its images.
struct SimulatedData {
  calibration::RigCalibration rig;
  std::vector<std::int64_t> frame_ns;  ///< the instants at which the images are taken
  sensors::ImageStamps color;          ///< what the lists say of them; those that are dropped are left out
  sensors::ImageStamps depth;          ///< the same of depth; equal to color where a format pairs them
  bool paired = true;                  ///< the TUM layout lists the pairs as well
  Trajectory truth;  ///< colour camera in the scene's world: all frames, and poses between them
  sensors::SimulatedImu imu;
  Mesh scene;

  [[nodiscard]] bool has_frame(std::size_t frame) const {
    return !color.dropped[frame] && !depth.dropped[frame];
  }
};

/// One layout: its clock, its names and its lists.
struct LayoutDescription {
  std::string_view name;
  std::int64_t first_frame_ns;  ///< stamp of frame 0
  std::int64_t imu_lead_ns;     ///< how long before it the IMU begins
  std::int64_t tick_ns;         ///< stamps are multiples of it
  bool has_stamps;              ///< or frames are counted
  bool separate_lists;          ///< colour and depth have stamps of their own
  double lowest_rate_hz;        ///< of the images; what readers of the format take
  double highest_rate_hz;
  sensors::DepthNoise depth_noise;  ///< of the sensor that the layout is known for
  std::string (*color_name)(std::size_t frame, std::int64_t frame_ns);  ///< relative to the folder
  std::string (*depth_name)(std::size_t frame, std::int64_t frame_ns);
  /// Lists, IMU and ground truth of the format.
  Result<void> (*write_lists)(const std::filesystem::path& folder, const SimulatedData& data);
  /// Maps points of the scene's world into the world of scene.ply and of the states (both right-handed).
  SE3 (*T_file_scene)(const SimulatedData& data);

  [[nodiscard]] std::int64_t frame_ns(std::size_t frame, double rate_hz) const;
};
[[nodiscard]] const LayoutDescription& describe(RecordingLayout layout);

/// The sensors that a layout is known for, at an image size: the published intrinsics (scaled with the
/// width), depth in a camera of its own (zr300) or registered to colour, and the IMU of the ZR300. Global
/// shutters. Error configuration: a size out of range.
[[nodiscard]] Result<calibration::RigCalibration> layout_rig(RecordingLayout layout,
                                                             const images::ImageSize& size);

/// Writes everything but the images. Errors: io.
[[nodiscard]] Result<void> write_layout(RecordingLayout layout, const std::filesystem::path& folder,
                                        const SimulatedData& data);

}  // namespace fusebench::simulator::layouts
