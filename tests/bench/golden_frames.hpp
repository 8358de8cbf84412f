// The images of the recorded frames that lie beside the tests, for the programs that measure reading them.
// What inflating costs depends on what is in a file, so they are a sensor's own.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "datasets/images/image_files.hpp"

namespace fusebench::testing {

/// A recording of five frames.
inline std::filesystem::path golden_folder() {
  return std::filesystem::path(FUSEBENCH_GOLDEN) / "tum_freiburg1_rpy_5frames";
}

/// Both images of a frame, and their files.
struct ImagePair {
  ColorImage color;
  Image<std::uint16_t> depth;
};
struct ImagePairFiles {
  std::filesystem::path color;
  std::filesystem::path depth;
};
inline ImagePairFiles golden_pair_files() {
  return {golden_folder() / "rgb" / "1305031229.528748.png",
          golden_folder() / "depth" / "1305031229.528784.png"};
}

inline Result<ImagePair> read_pair(const ImagePairFiles& files) {
  auto color = images::read_color(files.color);
  if (!color) return tl::unexpected(color.error());
  auto depth = images::read_depth16(files.depth);
  if (!depth) return tl::unexpected(depth.error());
  return ImagePair{std::move(*color), std::move(*depth)};
}

/// Of their size, with depth in most pixels.
inline bool is_golden_pair(const ImagePair& pair) {
  const auto measured = std::ranges::count_if(pair.depth.data, [](std::uint16_t z) { return z > 0; });
  return pair.color.width == 640 && 2 * measured > std::ssize(pair.depth.data);
}

}  // namespace fusebench::testing
