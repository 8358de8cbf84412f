#include "datasets/recording/formats/rosbag/bag_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/printable.hpp"

namespace fusebench::formats::rosbag {

namespace {

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// Takes the messages of a bag apart.
class Collector {
 public:
  explicit Collector(std::string file) : file_(std::move(file)) {}

  Result<void> take(const Message& message) {
    const std::string& type = message.connection.type;
    const std::string& topic = message.connection.topic;
    bool sound = true;
    if (type == "sensor_msgs/Image") {
      sound = take_image(message, image_message(message.data), false);
    } else if (type == "sensor_msgs/CompressedImage") {
      sound = take_image(message, compressed_image_message(message.data), true);
    } else if (type == "sensor_msgs/CameraInfo") {
      if (!topics.cameras.contains(topic)) {
        const auto camera = camera_info_message(message.data);
        sound = camera.has_value();
        if (sound) topics.cameras.emplace(topic, *camera);
      }
    } else if (type == "sensor_msgs/Imu") {
      auto sample = imu_message(message.data);
      sound = sample.has_value();
      if (sound) topics.imus[topic].samples.push_back(std::move(*sample));
    } else if (type == "tf2_msgs/TFMessage" && contains(topic, "tf_static")) {
      sound = take_transforms(message);
    } else if (type.ends_with("/Extrinsics")) {
      const auto T = extrinsics_message(message.data);
      sound = T.has_value();
      if (sound) topics.extrinsics.insert_or_assign(topic, *T);
    }
    if (sound) return {};
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: byte {}: a message of {} is no {} that can be read", file_,
                    message.place.chunk_bytes > 0 ? message.place.chunk_position : message.place.position,
                    printable(topic, 100), printable(type, 100)));
  }

  BagTopics topics;

 private:
  bool take_image(const Message& message, const std::optional<ImageMessage>& image, bool is_compressed) {
    if (!image) return false;
    const auto [entry, is_new] = topics.images.try_emplace(message.connection.topic);
    ImageTopic& topic = entry->second;
    if (is_new) {
      topic.kind = kind_of(*image);
      topic.is_compressed = is_compressed;
      topic.is_grey = is_grey_encoding(image->encoding);
      topic.frame_id = image->header.frame_id;
    }
    const std::int64_t stamp_ns = image->header.timestamp_ns;
    topic.images.push_back({stamp_ns != 0 ? stamp_ns : message.recorded_ns, message.place});
    return true;
  }

  bool take_transforms(const Message& message) {
    const auto transforms = tf_message(message.data);
    if (!transforms) return false;
    // A static transform may be sent again and again.
    for (const TransformMessage& t : *transforms) {
      if (!topics.frames.transform(t.header.frame_id, t.child_frame_id))
        topics.frames.add(t.header.frame_id, t.child_frame_id, t.T_parent_child);
    }
    return true;
  }

  std::string file_;
};

void sort_images(ImageTopic& topic) {
  const auto earlier = [](const StoredMessage& a, const StoredMessage& b) {
    return a.timestamp_ns < b.timestamp_ns;
  };
  std::ranges::stable_sort(topic.images, earlier);
  const auto same = [](const StoredMessage& a, const StoredMessage& b) {
    return a.timestamp_ns == b.timestamp_ns;
  };
  const auto rest = std::ranges::unique(topic.images, same);
  topic.repeated = static_cast<std::size_t>(std::ranges::ssize(rest));
  topic.images.erase(rest.begin(), rest.end());
}

std::vector<std::string_view> components_of(std::string_view topic) {
  std::vector<std::string_view> components;
  while (!topic.empty()) {
    const std::size_t slash = std::min(topic.find('/'), topic.size());
    if (slash > 0) components.push_back(topic.substr(0, slash));
    topic.remove_prefix(std::min(slash + 1, topic.size()));
  }
  return components;
}

/// How well a topic's name fits; below 0: not at all. Of equals the first by name is taken.
int fitness(std::string_view topic, const ImageTopic& images, ImageKind kind) {
  if (images.kind != kind || contains(topic, "infra") || contains(topic, "/ir") ||
      contains(topic, "fisheye") || contains(topic, "confidence"))
    return -1;
  const bool named = kind == ImageKind::color ? contains(topic, "color") || contains(topic, "rgb")
                                              : contains(topic, "depth");
  const bool aligned = contains(topic, "aligned") || contains(topic, "registered");
  return (images.is_grey ? 0 : 8) + (named ? 4 : 0) + (kind == ImageKind::depth && aligned ? 2 : 0) +
         (images.is_compressed ? 0 : 1);
}

std::optional<std::string> best_topic(const BagTopics& topics, ImageKind kind) {
  std::optional<std::string> best;
  int best_fitness = -1;
  for (const auto& [topic, images] : topics.images) {
    const int fits = fitness(topic, images, kind);
    if (fits <= best_fitness) continue;
    best = topic;
    best_fitness = fits;
  }
  return best;
}

std::string list_of_images(const BagTopics& topics) {
  std::string text;
  for (const auto& [topic, images] : topics.images) {
    if (text.size() > 300) return "is " + text + ", ...";
    text +=
        fmt::format("{}{} ({} images)", text.empty() ? "" : ", ", printable(topic, 80), images.images.size());
  }
  return text.empty() ? "are no images at all" : "is " + text;
}

}  // namespace

Result<BagTopics> read_topics(const std::filesystem::path& file) {
  Collector collector(file.string());
  const auto content = read_bag(file, [&](const Message& message) { return collector.take(message); });
  if (!content) return tl::unexpected(content.error());
  BagTopics& topics = collector.topics;
  topics.ends_early = content->ends_early;
  for (auto& [topic, images] : topics.images) sort_images(images);
  for (auto& [topic, imu] : topics.imus) imu.frame_id = imu.samples.front().header.frame_id;
  return std::move(topics);
}

Result<ChosenTopics> choose_topics(const BagTopics& topics, const std::filesystem::path& file) {
  const auto color = best_topic(topics, ImageKind::color);
  const auto depth = best_topic(topics, ImageKind::depth);
  if (color && depth) return ChosenTopics{*color, *depth};
  if (topics.ends_early) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: ends within a record, before any {} image (up to there, there {})",
                            file.string(), color ? "depth" : "colour", list_of_images(topics)),
                "the file is cut off: copy or download it again");
  }
  return fail(ErrorCode::data_missing,
              fmt::format("{}: no topic with {} images; there {}", file.string(), color ? "depth" : "colour",
                          list_of_images(topics)),
              "needed are rgb8, bgr8, mono8 or JPEG for colour, and 16UC1 or 32FC1 for depth");
}

Result<std::optional<calibration::CalibratedCamera>> camera_of_topic(const BagTopics& topics,
                                                                     std::string_view image_topic) {
  const std::vector<std::string_view> image = components_of(image_topic);
  for (const auto& [topic, camera] : topics.cameras) {
    const std::vector<std::string_view> info = components_of(topic);
    const auto [end, ignored] = std::ranges::mismatch(info, image);
    const auto common = static_cast<std::size_t>(end - info.begin());
    // ".../color/camera_info", and ".../Color_0/info/camera_info" of RealSense's own recorder.
    const std::size_t own = info.size() >= 2 && info[info.size() - 2] == "info" ? 2 : 1;
    if (info.size() > own && common >= info.size() - own) {
      if (camera) return *camera;
      Error error = camera.error();
      error.message = fmt::format("{}: {}", printable(topic, 100), error.message);
      return tl::unexpected(std::move(error));
    }
  }
  return std::optional<calibration::CalibratedCamera>();
}

}  // namespace fusebench::formats::rosbag
