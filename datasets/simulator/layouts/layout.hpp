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

/// All data of a simulated recording except its images.
struct SimulatedData {
  calibration::RigCalibration rig;
  std::vector<std::int64_t> frame_ns;  ///< capture instants of the images
  sensors::ImageStamps color;          ///< stamps in the lists, without dropped images
  sensors::ImageStamps depth;          ///< depth stamps; equal to color if the format pairs them
  bool paired = true;                  ///< the TUM layout also lists the pairs
  Trajectory truth;  ///< pose of the colour camera in the scene's world: all frames, and poses between them
  sensors::SimulatedImu imu;
  Mesh scene;

  [[nodiscard]] bool has_frame(std::size_t frame) const {
    return !color.dropped[frame] && !depth.dropped[frame];
  }
};

/// A layout: its clock, file names and lists.
struct LayoutDescription {
  std::string_view name;
  std::int64_t first_frame_ns;  ///< stamp of frame 0
  std::int64_t imu_lead_ns;     ///< start of the IMU before frame 0
  std::int64_t tick_ns;         ///< stamps are multiples of this
  bool has_stamps;              ///< false: frames are numbered
  bool separate_lists;          ///< colour and depth have separate stamps
  double lowest_rate_hz;        ///< of the images; limit of the readers of the format
  double highest_rate_hz;
  sensors::DepthNoise depth_noise;  ///< of the typical sensor of the layout
  std::string (*color_name)(std::size_t frame, std::int64_t frame_ns);  ///< relative to the folder
  std::string (*depth_name)(std::size_t frame, std::int64_t frame_ns);
  /// Writes the lists, the IMU file and the ground truth of the format.
  Result<void> (*write_lists)(const std::filesystem::path& folder, const SimulatedData& data);
  /// Transform from the scene's world to the world of scene.ply and of the states (both right-handed).
  SE3 (*T_file_scene)(const SimulatedData& data);

  [[nodiscard]] std::int64_t frame_ns(std::size_t frame, double rate_hz) const;
};
[[nodiscard]] const LayoutDescription& describe(RecordingLayout layout);

/// The typical sensors of a layout at an image size: published intrinsics (scaled with the width), depth in a
/// separate camera (zr300) or registered to colour, and the IMU of the ZR300. Global shutters. Error
/// configuration: a size out of range.
[[nodiscard]] Result<calibration::RigCalibration> layout_rig(RecordingLayout layout,
                                                             const images::ImageSize& size);

/// Writes all files except the images. Errors: io.
[[nodiscard]] Result<void> write_layout(RecordingLayout layout, const std::filesystem::path& folder,
                                        const SimulatedData& data);

}  // namespace fusebench::simulator::layouts
