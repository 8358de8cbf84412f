// Files of rosbag, version 2.0 (http://wiki.ros.org/Bags/Format/2.0). Little-endian:
//
//     "#ROSBAG V2.0\n", then records: uint32 n, n bytes of fields, uint32 m, m bytes of data
//     a field                uint32 n, n bytes: name=value
//     op 3 bag header        padding
//     op 5 chunk             compression = none, bz2 or lz4; size = of its records once decompressed;
//                            data: records of op 7 and 2
//     op 7 connection        conn, topic; data: fields, among them type
//     op 2 message           conn, time = uint32 seconds, uint32 nanoseconds; data: as ROS serialises it
//     op 4, 6                indices, which are not used: a bag that was not closed has none
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace fusebench::formats::rosbag {

struct Connection {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Image"
};

/// Where a message lies: in a chunk, or (chunk_bytes = 0) in the file itself.
struct MessagePlace {
  std::uint64_t chunk_position = 0;
  std::uint64_t chunk_bytes = 0;  ///< as stored
  std::uint64_t chunk_size = 0;   ///< decompressed
  std::string compression;
  std::uint64_t position = 0;  ///< within the decompressed chunk, or the file
  std::uint64_t bytes = 0;
};

struct Message {
  const Connection& connection;
  std::int64_t recorded_ns = 0;
  std::string_view data;
  MessagePlace place;
};

/// Calls use for every message in the order of the file, up to the first error. A bag that ends within a
/// record (its recorder was killed) is read up to there. Errors name file and byte: data_missing;
/// data_corrupt (no bag of version 2.0, a record that cannot be, a chunk that is damaged or larger than 1
/// GiB); those of use.
struct BagContent {
  std::map<std::uint32_t, Connection> connections;
  bool ends_early = false;
};
[[nodiscard]] Result<BagContent> read_bag(const std::filesystem::path& file,
                                          const std::function<Result<void>(const Message&)>& use);

/// The data of a message that read_bag() has seen. Errors: data_missing, data_corrupt (the file has changed).
[[nodiscard]] Result<std::string> message_data(const std::filesystem::path& file, const MessagePlace& place);

}  // namespace fusebench::formats::rosbag
