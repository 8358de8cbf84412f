// Bags of hand-made records, for tests of what no recorder writes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fusebench::testing {

template <class Number>
std::string little_endian(Number value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  return {raw.data(), raw.size()};
}

inline std::string with_length(std::string_view bytes) {
  return little_endian(static_cast<std::uint32_t>(bytes.size())) + std::string(bytes);
}

using BagFields = std::vector<std::pair<std::string, std::string>>;

inline std::string bag_fields(const BagFields& fields) {
  std::string bytes;
  for (const auto& [name, value] : fields) bytes += with_length(name + "=" + value);
  return bytes;
}

inline std::string bag_record(char operation, const BagFields& fields, std::string_view data) {
  return with_length(with_length(std::string("op=") + operation) + bag_fields(fields)) + with_length(data);
}

inline std::string bag_connection(std::uint32_t id, const std::string& topic, const std::string& type) {
  return bag_record(7, {{"conn", little_endian(id)}, {"topic", topic}},
                    bag_fields({{"topic", topic}, {"type", type}}));
}

/// recorded at `seconds`.
inline std::string bag_message(std::uint32_t id, std::uint32_t seconds, std::string_view data) {
  return bag_record(
      2, {{"conn", little_endian(id)}, {"time", little_endian(seconds) + little_endian(std::uint32_t{0})}},
      data);
}

inline std::string bag_chunk(std::string_view stored, std::size_t size, const std::string& compression) {
  return bag_record(
      5, {{"compression", compression}, {"size", little_endian(static_cast<std::uint32_t>(size))}}, stored);
}

inline std::string ros_header(std::uint32_t seconds, std::uint32_t nanoseconds, std::string_view frame_id) {
  return little_endian(std::uint32_t{0}) + little_endian(seconds) + little_endian(nanoseconds) +
         with_length(frame_id);
}

inline std::string ros_image(const std::string& header, std::uint32_t width, std::uint32_t height,
                             std::string_view encoding, std::uint32_t step, std::string_view data) {
  return header + little_endian(height) + little_endian(width) + with_length(encoding) + '\0' +
         little_endian(step) + with_length(data);
}

inline std::string ros_camera_info(const std::string& header, std::uint32_t width, std::uint32_t height,
                                   std::string_view model, const std::vector<double>& distortion,
                                   const std::array<double, 9>& K) {
  std::string bytes = header + little_endian(height) + little_endian(width) + with_length(model) +
                      little_endian(static_cast<std::uint32_t>(distortion.size()));
  for (const double value : distortion) bytes += little_endian(value);
  for (const double value : K) bytes += little_endian(value);
  return bytes;
}

inline std::string ros_imu(const std::string& header, const std::array<double, 3>& rate,
                           const std::array<double, 3>& force) {
  std::string bytes = header + std::string(13 * 8, '\0');
  for (const double value : rate) bytes += little_endian(value);
  bytes += std::string(9 * 8, '\0');
  for (const double value : force) bytes += little_endian(value);
  return bytes + std::string(9 * 8, '\0');
}

}  // namespace fusebench::testing
