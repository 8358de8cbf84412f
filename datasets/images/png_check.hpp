// What PNG files claim and what is damaged in them, before a decoder sees them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fusebench::images {

struct ClaimedSize {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
};

/// The size that the header of a PNG claims, from the beginning of its bytes: nothing else of it is looked
/// at. None if it is no PNG, or ends before.
[[nodiscard]] std::optional<ClaimedSize> png_claim(std::string_view bytes);

/// What is wrong with a PNG file's chunks ("truncated PNG ...", "damaged PNG ..."), by their lengths and
/// checksums; empty if nothing is, or if the file is not a PNG (or cannot be read: whoever opens it next will
/// say so).
[[nodiscard]] std::string png_damage(const std::filesystem::path& file);

}  // namespace fusebench::images
