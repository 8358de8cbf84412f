#include "datasets/recording/formats/rosbag/bag_imu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/base/printable.hpp"
#include "datasets/recording/reading/inertial_samples.hpp"
#include "datasets/recording/sensor_columns.hpp"

namespace fusebench::formats::rosbag {

namespace {

using Imus = std::map<std::string, ImuTopic>;

Imus::const_iterator topic_with(const Imus& imus, std::string_view part) {
  return std::ranges::find_if(imus, [&](const auto& entry) {
    std::string name = entry.first;
    for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return name.find(part) != std::string::npos;
  });
}

Result<void> check_ranges(const std::string& source, const ImuTopic& imu) {
  for (const ImuMessage& sample : imu.samples) {
    if (sample.angular_velocity_radps.cwiseAbs().maxCoeff() <= recording::kMaxAngularVelocity_radps &&
        sample.specific_force_mps2.cwiseAbs().maxCoeff() <= recording::kMaxSpecificForce_mps2)
      continue;
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: the message at {} ns has values that no sensor measures", source,
                            sample.header.timestamp_ns));
  }
  return {};
}

/// In the order of time; of equal stamps the first.
template <class Sample>
void sort_by_time(std::vector<Sample>& samples) {
  std::ranges::stable_sort(samples, {}, &Sample::timestamp_ns);
  const auto repeated = std::ranges::unique(samples, {}, &Sample::timestamp_ns);
  samples.erase(repeated.begin(), repeated.end());
}

/// Samples in the order of time. only_new: those whose value is new and not zero in the order of arrival, in
/// which a copy follows its original; a sensor that lags has copies of the other one with stamps before their
/// original's.
template <class Sample>
std::vector<Sample> samples_of(const ImuTopic& imu, Vector3d ImuMessage::*value, bool only_new) {
  std::vector<Sample> samples;
  Vector3d last = Vector3d::Zero();
  for (const ImuMessage& message : imu.samples) {
    const Vector3d& now = message.*value;
    if (only_new && (now == last || now.isZero(0))) continue;
    last = now;
    samples.push_back({message.header.timestamp_ns, now});
  }
  sort_by_time(samples);
  return samples;
}

/// Of one of the sensors: that a message has the value of the one before, or none.
std::size_t repeats_of(const ImuTopic& imu, Vector3d ImuMessage::*value) {
  std::size_t repeats = 0;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const Vector3d& now = imu.samples[k].*value;
    if (now == imu.samples[k - 1].*value || now.isZero(0)) ++repeats;
  }
  return repeats;
}

/// A topic, for messages.
struct Source {
  std::string file;
  std::string topic;
  [[nodiscard]] std::string text() const { return fmt::format("{}: {}", file, topic); }
};

Result<void> join(const Source& source, const ImuTopic& gyroscope, const ImuTopic& accelerometer,
                  bool only_new, recording::Recording& recording) {
  const auto rates =
      samples_of<reading::GyroscopeSample>(gyroscope, &ImuMessage::angular_velocity_radps, only_new);
  const auto forces =
      samples_of<recording::AccelerometerSample>(accelerometer, &ImuMessage::specific_force_mps2, only_new);
  recording.notes.push_back(fmt::format("{}: {} accelerometer samples are interpolated to {} gyroscope times",
                                        source.topic, forces.size(), rates.size()));
  return reading::set_imu(source.text(), rates, forces, recording);
}

Result<void> take_united(const Source& source, const ImuTopic& imu, recording::Recording& recording) {
  const std::size_t many = imu.samples.size() / 5 + 1;  // noise does not repeat that often
  if (repeats_of(imu, &ImuMessage::angular_velocity_radps) > many ||
      repeats_of(imu, &ImuMessage::specific_force_mps2) > many)
    return join(source, imu, imu, true, recording);
  for (const ImuMessage& sample : imu.samples) {
    recording.imu.push_back(
        {sample.header.timestamp_ns, sample.angular_velocity_radps, sample.specific_force_mps2});
  }
  sort_by_time(recording.imu);
  recording.imu_source = recording::ImuSource::recorded;
  return {};
}

}  // namespace

Result<std::string> take_imu(const BagTopics& topics, const std::filesystem::path& file,
                             recording::Recording& recording) {
  const Imus& imus = topics.imus;
  if (imus.empty()) return std::string();
  const auto source = [&](const std::string& topic) { return Source{file.string(), printable(topic, 100)}; };
  for (const auto& [topic, imu] : imus) {
    if (const auto possible = check_ranges(source(topic).text(), imu); !possible)
      return tl::unexpected(possible.error());
  }
  const auto gyroscope = topic_with(imus, "gyro");
  const auto accelerometer = topic_with(imus, "accel");
  const bool apart = gyroscope != imus.end() && accelerometer != imus.end() && gyroscope != accelerometer;
  const auto united = topic_with(imus, "imu") == imus.end() ? imus.begin() : topic_with(imus, "imu");
  const auto used = apart ? gyroscope : united;
  const auto taken =
      apart ? join(source(gyroscope->first), gyroscope->second, accelerometer->second, false, recording)
            : take_united(source(united->first), united->second, recording);
  if (!taken) return tl::unexpected(taken.error());
  return used->second.frame_id;
}

}  // namespace fusebench::formats::rosbag
