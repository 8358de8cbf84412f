// Inertial samples of a bag.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "datasets/recording/formats/rosbag/bag_topics.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::rosbag {

/// Fills recording.imu and imu_source, and returns the frame of the gyroscope; an empty name if there are no
/// inertial messages. Two topics ("accel" and "gyro" in their names) are joined, as is one whose messages
/// repeat or leave out one of the two: drivers that "copy" or interleave send each sensor's value when the
/// other has a new one. Error data_corrupt: a value beyond the limits of sensor_columns.hpp, nothing that can
/// be joined.
[[nodiscard]] Result<std::string> take_imu(const BagTopics& topics, const std::filesystem::path& file,
                                           recording::Recording& recording);

}  // namespace fusebench::formats::rosbag
