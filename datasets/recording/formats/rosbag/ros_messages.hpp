// The ROS 1 messages that a recording is made of, as ROS serialises them (little-endian, strings and lists
// with their length before them).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::formats::rosbag {

struct Header {
  std::int64_t timestamp_ns = 0;
  std::string frame_id;
};

/// sensor_msgs/Image, or sensor_msgs/CompressedImage with its format as encoding and no size.
struct ImageMessage {
  Header header;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::string encoding;
  bool is_big_endian = false;
  std::uint32_t step_bytes = 0;  ///< of a row
  std::string_view data;         ///< of the message
};

struct ImuMessage {
  Header header;
  Vector3d angular_velocity_radps = Vector3d::Zero();
  Vector3d specific_force_mps2 = Vector3d::Zero();
};

/// geometry_msgs/TransformStamped.
struct TransformMessage {
  Header header;  ///< of the parent
  std::string child_frame_id;
  SE3 T_parent_child;
};

// Nothing if the data end early, or a number in them cannot be.
[[nodiscard]] std::optional<ImageMessage> image_message(std::string_view data);
[[nodiscard]] std::optional<ImageMessage> compressed_image_message(std::string_view data);
[[nodiscard]] std::optional<ImuMessage> imu_message(std::string_view data);
/// sensor_msgs/CameraInfo: K and distortion. Error: that of calibration::distortion_of_model().
[[nodiscard]] std::optional<Result<calibration::CalibratedCamera>> camera_info_message(std::string_view data);
/// tf2_msgs/TFMessage.
[[nodiscard]] std::optional<std::vector<TransformMessage>> tf_message(std::string_view data);
/// realsense2_camera/Extrinsics: the rotation column by column, then the translation in metres.
[[nodiscard]] std::optional<SE3> extrinsics_message(std::string_view data);

/// What an image is of, by its encoding: "rgb8", "bgr8", "mono8" and the like, JPEG or PNG; "16UC1",
/// "mono16", "32FC1", compressed depth. Others are neither.
enum class ImageKind { color, depth, other };
[[nodiscard]] ImageKind kind_of(const ImageMessage& image);

/// Of images that are not compressed.
inline constexpr std::string_view kColorEncodings = "rgb8, bgr8, rgba8, bgra8, mono8";
inline constexpr std::string_view kDepthEncodings = "16UC1, mono16, 32FC1";
[[nodiscard]] bool is_color_encoding(std::string_view encoding);
[[nodiscard]] bool is_grey_encoding(std::string_view encoding);  ///< one of the above
[[nodiscard]] bool is_depth_encoding(std::string_view encoding);
/// compressed_depth_image_transport's, with 12 bytes before the image.
[[nodiscard]] bool is_compressed_depth(std::string_view encoding);

inline constexpr std::uint32_t kMostPixelsASide = 16384;

}  // namespace fusebench::formats::rosbag
