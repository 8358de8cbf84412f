// What a bag holds of a camera: its topics by what their messages are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/calibration/frame_tree.hpp"
#include "datasets/recording/formats/rosbag/bag_file.hpp"
#include "datasets/recording/formats/rosbag/ros_messages.hpp"

namespace fusebench::formats::rosbag {

struct StoredMessage {
  std::int64_t timestamp_ns = 0;  ///< of the header; where that is 0, when the message was recorded
  MessagePlace place;
};

struct ImageTopic {
  ImageKind kind = ImageKind::other;
  bool is_compressed = false;
  bool is_grey = false;
  std::string frame_id;
  std::vector<StoredMessage> images;  ///< in strictly increasing time
  std::size_t repeated = 0;           ///< images with the stamp of another, which are left out
};

struct ImuTopic {
  std::string frame_id;
  std::vector<ImuMessage> samples;  ///< in the order of arrival; stamps may repeat and run backwards
};

/// By topic.
struct BagTopics {
  std::map<std::string, ImageTopic> images;
  /// The first camera_info of each; an error for one that cannot be used.
  std::map<std::string, Result<calibration::CalibratedCamera>> cameras;
  std::map<std::string, ImuTopic> imus;
  std::map<std::string, SE3> extrinsics;
  calibration::FrameTree frames;  ///< of /tf_static
  bool ends_early = false;
};

/// Errors: those of read_bag; data_corrupt (a message that is not of its type).
[[nodiscard]] Result<BagTopics> read_topics(const std::filesystem::path& file);

/// The topic of colour, and of depth: aligned to colour before others, grey
/// images for colour only if there is no colour, images of infrared cameras never.
/// Errors: data_missing (there is none; the message lists what there is), data_corrupt (the bag is cut off).
struct ChosenTopics {
  std::string color;
  std::string depth;
};
[[nodiscard]] Result<ChosenTopics> choose_topics(const BagTopics& topics, const std::filesystem::path& file);

/// The camera_info of an image topic; nothing if there is none. Error data_corrupt: its distortion is not
/// supported.
[[nodiscard]] Result<std::optional<calibration::CalibratedCamera>> camera_of_topic(
    const BagTopics& topics, std::string_view image_topic);

}  // namespace fusebench::formats::rosbag
