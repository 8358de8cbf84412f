// Checks PNG files for size and damage before decoding.
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

/// The size in the header of a PNG, from its first bytes only. Nothing if it is not a PNG or truncated.
[[nodiscard]] std::optional<ClaimedSize> png_claim(std::string_view bytes);

/// Describes damage in the chunks of a PNG file ("truncated PNG ...", "damaged PNG ..."), by their lengths
/// and checksums. Empty if there is none, if the file is not a PNG, or if it cannot be read (the decoder
/// reports that).
[[nodiscard]] std::string png_damage(const std::filesystem::path& file);

}  // namespace fusebench::images
