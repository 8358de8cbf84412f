// ROS 1 bags of RGB-D cameras as recordings: RealSense (D435i, D455, ZR300), Kinect, Azure Kinect.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::rosbag {

/// A file whose name ends with .bag, or a folder that holds exactly one.
[[nodiscard]] bool is_rosbag(const std::filesystem::path& place);

/// Topics are known by their types and names (bag_topics.hpp): colour, depth (16-bit millimetres or metres in
/// floats; aligned to colour before others), camera_info of each, and sensor_msgs/Imu. Images are paired by
/// TUM's rule. Depth that is not aligned needs its own camera_info and a transform into colour: a message of
/// realsense2_camera/Extrinsics ("depth_to_color"), or /tf_static. The IMU sits where /tf_static says; its
/// noise is that of realsense_imu.hpp. Calibration: the options', calibration.toml beside the file, else
/// these. groundtruth.txt is taken from beside, and so is imu.csv where the bag has no inertial messages.
/// Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_rosbag(const std::filesystem::path& place,
                                                       const recording::ReadOptions& options);

/// A bag of ROS 2: .db3, .mcap, or a folder of one.
[[nodiscard]] bool is_rosbag2(const std::filesystem::path& place);

/// Why it is not read, and what converts it (configuration).
[[nodiscard]] Error refusal_of_rosbag2(const std::filesystem::path& place);

}  // namespace fusebench::formats::rosbag
