// The filters of PNG rows (PNG specification, section 9), undone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fusebench::images {

/// Undoes the filter of a row of pixels with kPixelBytes bytes: 2 or 3. filtered: the row as it is stored,
/// less the number of its filter. above: the row before with its filter undone, zeros for the first. All
/// three rows have the same size, a whole number of pixels, and `row` shares no memory with the others. False
/// if there is no such filter; they are numbered 0 to 4.
template <std::size_t kPixelBytes>
[[nodiscard]] bool undo_png_filter(int filter, std::span<const std::uint8_t> filtered,
                                   std::span<const std::uint8_t> above, std::span<std::uint8_t> row);

}  // namespace fusebench::images
