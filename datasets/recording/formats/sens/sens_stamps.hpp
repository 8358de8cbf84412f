// Stamps of .sens files, whose unit is not documented and of which writers leave some out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fusebench::formats::sens {

/// The most frames whose stamps rise, in order; not those of the few stamps that jump back or ahead.
[[nodiscard]] std::vector<std::size_t> rising_stamps(std::span<const std::uint64_t> stamps);

/// At least two, and two of three: the others are odd ones, and not the rule.
[[nodiscard]] bool enough_rise(std::size_t rising, std::size_t all);

/// How stamps of images are read.
struct ImageStamps {
  std::optional<std::int64_t> unit_ns;  ///< of the stamps; nothing if they cannot be used
  std::vector<std::size_t> frames;      ///< whose stamps can be used
  std::string reason;                   ///< why they cannot: "the .sens file has no stamps"
};

/// Stamps can be used if enough of them rise and their median spacing is one of images in s, ms, us or ns. Of
/// a first or last stamp that is 100 spacings from all others the frame is left out.
[[nodiscard]] ImageStamps image_stamps(std::span<const std::uint64_t> stamps);

}  // namespace fusebench::formats::sens
