// ROS 1 bags: records, compressed chunks, and the messages in them.
#include "datasets/recording/formats/rosbag/bag_imu.hpp"
#include "datasets/recording/formats/rosbag/bag_topics.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace formats::rosbag;

namespace {

void check_images(const std::filesystem::path& file, const ImageTopic& topic) {
  for (std::size_t i = 0; i < topic.images.size(); ++i) {
    check(i == 0 || topic.images[i - 1].timestamp_ns < topic.images[i].timestamp_ns,
          "time strictly increases");
    const auto data = message_data(file, topic.images[i].place);
    check(data.has_value(), "a message that was read is read again");
    const auto image = topic.is_compressed ? compressed_image_message(*data) : image_message(*data);
    check(image.has_value(), "and is the same");
  }
}

}  // namespace

void rosbag(std::string_view bytes) {
  static const MemoryFile file("room.bag");
  file.write(bytes);
  const auto topics = read_topics(file.path());
  if (!topics) return check_error(topics.error(), file.path());
  for (const auto& [name, topic] : topics->images) check_images(file.path(), topic);
  for (const auto& [name, camera] : topics->cameras)
    check(!camera || (camera->pinhole.fx_px > 0 && camera->pinhole.width_px > 0), "a camera can be one");
  recording::Recording recording;
  if (const auto imu = take_imu(*topics, file.path(), recording); !imu) check_error(imu.error(), file.path());
  for (std::size_t i = 1; i < recording.imu.size(); ++i)
    check(recording.imu[i - 1].timestamp_ns < recording.imu[i].timestamp_ns, "time strictly increases");
  const auto chosen = choose_topics(*topics, file.path());
  if (!chosen) return check_error(chosen.error(), file.path());
  static_cast<void>(camera_of_topic(*topics, chosen->color));
}

}  // namespace fusebench::fuzz
