// Bytes packed as zlib streams (RFC 1950), and depth images as such. The only user of zlib in this room.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/image.hpp"

namespace fusebench::image_logs {

/// A zlib stream of a depth image's values, rows from the top, little-endian 16 bits each.
[[nodiscard]] std::string packed_depth(const Image<std::uint16_t>& depth);

/// The image of such a stream; nothing if it is damaged or holds another number of pixels.
[[nodiscard]] std::optional<Image<std::uint16_t>> unpacked_depth(std::string_view packed, int width_px,
                                                                 int height_px);

/// The image of plain values, as above without compression; nothing if their number is another.
[[nodiscard]] std::optional<Image<std::uint16_t>> plain_depth(std::string_view values, int width_px,
                                                              int height_px);

}  // namespace fusebench::image_logs
