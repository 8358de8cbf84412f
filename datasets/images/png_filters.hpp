// Reverses the filters of PNG rows (PNG specification, section 9).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fusebench::images {

/// Reverses the filter of a row of pixels with kPixelBytes bytes (2 or 3). filtered: stored row without its
/// filter number. above: the previous reconstructed row, zeros for the first. All three rows have the same
/// size, a whole number of pixels, and `row` does not overlap the others. False for a filter other than 0 to
/// 4.
template <std::size_t kPixelBytes>
[[nodiscard]] bool undo_png_filter(int filter, std::span<const std::uint8_t> filtered,
                                   std::span<const std::uint8_t> above, std::span<std::uint8_t> row);

}  // namespace fusebench::images
