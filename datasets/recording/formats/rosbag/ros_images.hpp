// The pixels of ROS images.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "datasets/recording/formats/rosbag/ros_messages.hpp"

namespace fusebench::formats::rosbag {

/// The pixels. Errors data_corrupt, name in front: an encoding that is not read, data of another length.
/// depth: 16-bit values by units_per_metre, floats in metres.
[[nodiscard]] Result<ColorImage> color_of(const ImageMessage& image, const std::string& name);
[[nodiscard]] Result<DepthImage> depth_of(const ImageMessage& image, double units_per_metre,
                                          const std::string& name);

}  // namespace fusebench::formats::rosbag
