#include "datasets/recording/formats/rosbag/rosbag_recording.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/printable.hpp"
#include "datasets/recording/formats/rosbag/bag_imu.hpp"
#include "datasets/recording/formats/rosbag/bag_topics.hpp"
#include "datasets/recording/formats/rosbag/ros_images.hpp"
#include "datasets/recording/reading/image_pairs.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/realsense_imu.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/reading/single_file.hpp"

namespace fusebench::formats::rosbag {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 1000;

/// The images of the frames, where the bag has them.
struct BagImages {
  fs::path file;
  std::vector<MessagePlace> color;
  std::vector<MessagePlace> depth;
  bool color_is_compressed = false;
  bool depth_is_compressed = false;
};

bool is_aligned(const std::string& topic) {
  return topic.find("aligned") != std::string::npos || topic.find("registered") != std::string::npos;
}

Error in_bag(const fs::path& file, Error error) {
  error.message = fmt::format("{}: {}", file.string(), error.message);
  return error;
}

std::optional<SE3> color_from_depth(const BagTopics& topics, const ChosenTopics& chosen) {
  for (const auto& [topic, T] : topics.extrinsics) {
    if (topic.find("depth_to_color") != std::string::npos) return T;
  }
  const std::string& color = topics.images.at(chosen.color).frame_id;
  const std::string& depth = topics.images.at(chosen.depth).frame_id;
  return color == depth ? std::nullopt : topics.frames.transform(color, depth);
}

Result<std::optional<calibration::DepthCamera>> depth_camera(const BagTopics& topics,
                                                             const ChosenTopics& chosen,
                                                             const PinholeCamera& color, const fs::path& file,
                                                             std::vector<std::string>& warnings) {
  const auto found = camera_of_topic(topics, chosen.depth);
  if (!found && !is_aligned(chosen.depth)) return tl::unexpected(in_bag(file, found.error()));
  const auto info = found.value_or(std::nullopt);
  const bool one_camera = info && info->pinhole == color &&
                          topics.images.at(chosen.color).frame_id == topics.images.at(chosen.depth).frame_id;
  if (is_aligned(chosen.depth) || one_camera) return std::nullopt;
  const auto T_color_depth = color_from_depth(topics, chosen);
  if (info && T_color_depth) {
    if (!info->distortion.is_zero())
      warnings.push_back(fmt::format("{}: the distortion of the depth camera ({}) is not used", file.string(),
                                     printable(chosen.depth, 100)));
    return calibration::DepthCamera{info->pinhole, *T_color_depth};
  }
  return fail(
      ErrorCode::data_missing,
      fmt::format("{}: depth ({}) is not aligned to colour, and the bag has no {}", file.string(),
                  printable(chosen.depth, 100),
                  info ? "transform from its camera to that of colour (Extrinsics, /tf_static)"
                       : "camera_info of it"),
      "record with aligned depth (realsense2_camera: align_depth:=true), or put a calibration.toml with "
      "[depth] and T_color_depth beside the file");
}

Result<calibration::RigCalibration> calibration_of(const BagTopics& topics, const ChosenTopics& chosen,
                                                   const std::string& imu_frame, const fs::path& file,
                                                   std::vector<std::string>& warnings) {
  const auto found = camera_of_topic(topics, chosen.color);
  if (!found) return tl::unexpected(in_bag(file, found.error()));
  const auto& color = *found;
  if (!color)
    return fail(ErrorCode::configuration,
                fmt::format("{}: no camera_info beside {} says what camera it is of", file.string(),
                            printable(chosen.color, 100)),
                "give it with --camera fx,fy,cx,cy[,k1,k2,p1,p2,k3] or --calibration FILE.toml");
  calibration::RigCalibration calibration;
  calibration.color = *color;
  calibration.source = "camera_info of the bag";
  auto depth = depth_camera(topics, chosen, color->pinhole, file, warnings);
  if (!depth) return tl::unexpected(depth.error());
  calibration.depth = std::move(*depth);
  const auto T_imu_color = topics.frames.transform(imu_frame, topics.images.at(chosen.color).frame_id);
  if (!imu_frame.empty() && T_imu_color) {
    calibration.imu = calibration::ImuCalibration{*T_imu_color, reading::realsense_imu_noise()};
    calibration.source += fmt::format("; {}", reading::kRealsenseNoiseSource);
  }
  return calibration;
}

std::vector<std::int64_t> times_of(const ImageTopic& topic) {
  std::vector<std::int64_t> times_ns;
  for (const StoredMessage& image : topic.images) times_ns.push_back(image.timestamp_ns);
  return times_ns;
}

Result<BagImages> pair_topics(const fs::path& file, const BagTopics& topics, const ChosenTopics& chosen,
                              const recording::ReadOptions& options, recording::Recording& recording) {
  const ImageTopic& color = topics.images.at(chosen.color);
  const ImageTopic& depth = topics.images.at(chosen.depth);
  const std::vector<std::int64_t> color_ns = times_of(color);
  const std::vector<std::int64_t> depth_ns = times_of(depth);
  const auto pairs = reading::pair_times({"colour", color_ns}, {"depth", depth_ns}, options, recording);
  if (!pairs) return tl::unexpected(pairs.error());
  BagImages images{file, {}, {}, color.is_compressed, depth.is_compressed};
  for (const trajectory::AssociatedPair& pair : *pairs) {
    images.color.push_back(color.images[pair.first].place);
    images.depth.push_back(depth.images[pair.second].place);
  }
  recording.notes.push_back(
      fmt::format("topics: colour {}, depth {}", printable(chosen.color, 100), printable(chosen.depth, 100)));
  if (const std::size_t repeated = color.repeated + depth.repeated; repeated > 0)
    recording.warnings.push_back(
        fmt::format("{}: {} images repeat a stamp and are not used", recording.name, repeated));
  if (topics.ends_early)
    recording.warnings.push_back(
        fmt::format("{}: the bag ends within a record (its recorder did not close it)", file.string()));
  return images;
}

reading::StoredImages stored_images(const std::shared_ptr<const BagImages>& bag, double units_per_metre) {
  const auto stored = [bag](const MessagePlace& place, std::string_view what,
                            std::size_t frame) -> Result<reading::StoredImage> {
    auto data = message_data(bag->file, place);
    if (!data) return tl::unexpected(data.error());
    return reading::StoredImage{fmt::format("{}: {} of frame {}", bag->file.string(), what, frame),
                                std::move(*data)};
  };
  const auto parsed = [](const reading::StoredImage& image, bool is_compressed) -> Result<ImageMessage> {
    auto message = is_compressed ? compressed_image_message(image.bytes) : image_message(image.bytes);
    if (message) return std::move(*message);
    return fail(ErrorCode::data_corrupt, fmt::format("{}: a damaged message", image.name));
  };
  reading::StoredImages images;
  images.color = [bag, stored](std::size_t frame) { return stored(bag->color[frame], "colour", frame); };
  images.depth = [bag, stored](std::size_t frame) { return stored(bag->depth[frame], "depth", frame); };
  images.decode_color = [bag, parsed](const reading::StoredImage& image) {
    return parsed(image, bag->color_is_compressed).and_then([&](const ImageMessage& message) {
      return color_of(message, image.name);
    });
  };
  images.decode_depth = [bag, parsed, units_per_metre](const reading::StoredImage& image) {
    return parsed(image, bag->depth_is_compressed).and_then([&](const ImageMessage& message) {
      return depth_of(message, units_per_metre, image.name);
    });
  };
  return images;
}

}  // namespace

bool is_rosbag(const fs::path& place) { return reading::file_with_ending(place, ".bag").has_value(); }

Result<recording::Recording> open_rosbag(const fs::path& place, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(place, "rosbag");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const auto file = reading::file_with_ending(place, ".bag");
  if (!file)
    return fail(ErrorCode::data_missing, fmt::format("{}: not one .bag file", place.string()),
                "name the file, or a folder that holds one");
  recording.name = file->stem().string();
  const auto topics = read_topics(*file);
  if (!topics) return tl::unexpected(topics.error());
  const auto chosen = choose_topics(*topics, *file);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto imu_frame = take_imu(*topics, *file, recording);
  if (!imu_frame) return tl::unexpected(imu_frame.error());
  const fs::path folder = file->parent_path();
  auto calibration = recording::choose_calibration(
      folder, options,
      [&] { return calibration_of(*topics, *chosen, *imu_frame, *file, recording.warnings); }, recording);
  if (!calibration) return tl::unexpected(calibration.error());
  auto images = pair_topics(*file, *topics, *chosen, options, recording);
  if (!images) return tl::unexpected(images.error());
  if (const auto read = reading::read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  if (recording.imu.empty()) {
    if (const auto read = reading::read_imu_beside(folder, recording); !read)
      return tl::unexpected(read.error());
  }
  const double units = reading::settled_depth_units(*calibration, kUnitsPerMetre);
  const auto bag = std::make_shared<const BagImages>(std::move(*images));
  const auto attached = reading::attach_images(recording, *calibration, fmt::format("rosbag {}", units),
                                               reading::stored_images(stored_images(bag, units)));
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

bool is_rosbag2(const fs::path& place) {
  const auto is_one = [](const fs::path& file) {
    return file.extension() == ".db3" || file.extension() == ".mcap";
  };
  std::error_code ignored;
  if (fs::is_regular_file(place, ignored)) return is_one(place);
  for (const auto& entry : fs::directory_iterator(place, ignored)) {
    if (is_one(entry.path())) return true;
  }
  return false;
}

Error refusal_of_rosbag2(const fs::path& place) {
  return {ErrorCode::configuration,
          fmt::format("{}: bags of ROS 2 (.db3, .mcap) are not read", place.string()),
          "convert it to a ROS 1 bag: pip install rosbags; rosbags-convert --src FOLDER --dst room.bag"};
}

}  // namespace fusebench::formats::rosbag
