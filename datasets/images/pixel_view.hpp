// A view of the pixels of any image, for libraries.
#pragma once

#include <cstddef>
#include <span>

namespace fusebench::images {

enum class SampleType { uint8, uint16, float32, other };

/// Rows from the top without padding, interleaved channels, samples in native byte order.
struct PixelView {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;
  SampleType type = SampleType::uint8;  ///< never other
  std::span<const std::byte> pixels;
};

}  // namespace fusebench::images
