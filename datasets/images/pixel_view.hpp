// The pixels of an image of any kind, as libraries take them.
#pragma once

#include <cstddef>
#include <span>

namespace fusebench::images {

enum class SampleType { uint8, uint16, float32, other };

/// Rows from the top without padding, the channels of a pixel beside each other, samples of the machine's
/// byte order.
struct PixelView {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;
  SampleType type = SampleType::uint8;  ///< never other
  std::span<const std::byte> pixels;
};

}  // namespace fusebench::images
