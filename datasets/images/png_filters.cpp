#include "datasets/images/png_filters.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace fusebench::images {

namespace {

using ConstRow = std::span<const std::uint8_t>;
using Row = std::span<std::uint8_t>;

// Compiler vector types: the same result with any instruction set.
using Bytes4 [[gnu::vector_size(4)]] = std::uint8_t;
using Bytes16 [[gnu::vector_size(16)]] = std::uint8_t;
using Shorts4 [[gnu::vector_size(8)]] = std::int16_t;

constexpr std::size_t kLanes = sizeof(Bytes16);

/// Moves lane i - kBy to lane i and sets the first lanes to zero.
template <std::size_t kBy>
Bytes16 moved_up(Bytes16 bytes) {
  return [&]<std::size_t... lane>(std::index_sequence<lane...>) {
    return __builtin_shufflevector(Bytes16{}, bytes, (lane < kBy ? lane : kLanes + lane - kBy)...);
  }
  (std::make_index_sequence<kLanes>());
}

/// Repeats the pixel at kFirst.
template <std::size_t kFirst, std::size_t kPixelBytes>
Bytes16 repeated(Bytes16 bytes) {
  return [&]<std::size_t... lane>(std::index_sequence<lane...>) {
    return __builtin_shufflevector(bytes, bytes, (kFirst + lane % kPixelBytes)...);
  }
  (std::make_index_sequence<kLanes>());
}

/// Reverses filter 1, the difference to the previous pixel. Prefix sums of 2, 4 and 8 pixels give those of a
/// whole vector.
template <std::size_t kPixelBytes>
void add_left(ConstRow filtered, Row row) {
  constexpr std::size_t kStep = kLanes / kPixelBytes * kPixelBytes;
  Bytes16 left{};
  std::size_t at = 0;
  for (; at + kLanes <= row.size(); at += kStep) {
    Bytes16 sums;
    std::memcpy(&sums, &filtered[at], kLanes);
    sums += moved_up<kPixelBytes>(sums);
    sums += moved_up<2 * kPixelBytes>(sums);
    sums += moved_up<4 * kPixelBytes>(sums);
    sums += left;
    left = repeated<kStep - kPixelBytes, kPixelBytes>(sums);
    std::memcpy(&row[at], &sums, kLanes);
  }
  for (; at < row.size(); ++at) {
    const std::uint8_t before = at >= kPixelBytes ? row[at - kPixelBytes] : std::uint8_t{0};
    row[at] = static_cast<std::uint8_t>(filtered[at] + before);
  }
}

/// Reverses filter 2, the difference to the byte above.
void add_above(ConstRow filtered, ConstRow above, Row row) {
  for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<std::uint8_t>(filtered[i] + above[i]);
}

/// Reverses filter 3, the difference to the mean of the previous pixel and the one above, rounded down.
template <std::size_t kPixelBytes>
void add_mean(ConstRow filtered, ConstRow above, Row row) {
  std::array<std::uint8_t, kPixelBytes> left{};
  for (std::size_t at = 0; at < row.size(); at += kPixelBytes) {
    for (std::size_t i = 0; i < kPixelBytes; ++i) {
      left[i] = static_cast<std::uint8_t>(filtered[at + i] + (left[i] + above[at + i]) / 2);
      row[at + i] = left[i];
    }
  }
}

/// Loads up to four bytes.
template <std::size_t kCount>
Shorts4 load(const std::uint8_t* from) {
  Bytes4 bytes{};
  std::memcpy(&bytes, from, kCount);
  return __builtin_convertvector(bytes, Shorts4);
}

Shorts4 magnitude(Shorts4 values) { return values < 0 ? -values : values; }

/// Reverses filter 4: the difference to the one of left, above and above left (corner) that is closest to
/// left + above - corner, the first one on a tie.
template <std::size_t kPixelBytes>
void add_paeth(ConstRow filtered, ConstRow above, Row row) {
  Shorts4 left{};
  Shorts4 corner{};
  const auto add_pixel = [&]<std::size_t kCount>(std::size_t at) {
    const Shorts4 up = load<kCount>(&above[at]);
    const Shorts4 rise = up - corner;
    const Shorts4 by_left = magnitude(rise);
    const Shorts4 by_up = magnitude(left - corner);
    const Shorts4 by_corner = magnitude(left + (rise - corner));
    const Shorts4 other = by_corner < by_up ? corner : up;
    const Shorts4 by_other = by_corner < by_up ? by_corner : by_up;
    left = (load<kCount>(&filtered[at]) + (by_other < by_left ? other : left)) & 0xFF;
    corner = up;
    const Bytes4 sums = __builtin_convertvector(left, Bytes4);
    std::memcpy(&row[at], &sums, kCount);
  };
  constexpr std::size_t kAtOnce = sizeof(Bytes4);  // wider than a pixel; the next pixel overwrites the rest
  std::size_t at = 0;
  for (; at + kAtOnce <= row.size(); at += kPixelBytes) add_pixel.template operator()<kAtOnce>(at);
  for (; at < row.size(); at += kPixelBytes) add_pixel.template operator()<kPixelBytes>(at);
}

}  // namespace

template <std::size_t kPixelBytes>
bool undo_png_filter(int filter, ConstRow filtered, ConstRow above, Row row) {
  switch (filter) {
    case 0:
      std::ranges::copy(filtered, row.begin());
      return true;
    case 1:
      add_left<kPixelBytes>(filtered, row);
      return true;
    case 2:
      add_above(filtered, above, row);
      return true;
    case 3:
      add_mean<kPixelBytes>(filtered, above, row);
      return true;
    case 4:
      add_paeth<kPixelBytes>(filtered, above, row);
      return true;
    default:
      return false;
  }
}

template bool undo_png_filter<2>(int filter, ConstRow filtered, ConstRow above, Row row);
template bool undo_png_filter<3>(int filter, ConstRow filtered, ConstRow above, Row row);

}  // namespace fusebench::images
