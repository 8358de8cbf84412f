// LZ4 frames (LZ4 Frame Format 1.6, Collet), as ROS compresses chunks of bags. Decoding alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace fusebench::formats::rosbag {

/// The content of one frame of exactly `size` bytes; nothing if the frame is damaged, has another size or
/// needs a dictionary. Checksums of blocks and content are skipped: what is decoded is parsed after.
[[nodiscard]] std::optional<std::string> lz4_content(std::string_view frame, std::size_t size);

}  // namespace fusebench::formats::rosbag
