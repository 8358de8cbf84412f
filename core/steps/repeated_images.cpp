#include "core/steps/repeated_images.hpp"

#include <algorithm>
#include <string_view>

namespace fusebench::core {

namespace {

template <class Pixel>
io::ContentHash hash_of(const Image<Pixel>& image) {
  return io::content_hash(
      std::string_view(reinterpret_cast<const char*>(image.data.data()), image.data.size() * sizeof(Pixel)));
}

template <class Pixel>
bool is_uniform(const Image<Pixel>& image) {
  return std::ranges::all_of(image.data, [&](const Pixel& pixel) { return pixel == image.data.front(); });
}

}  // namespace

Novelty RepeatedImages::examine(const RgbdFrame& frame) {
  const io::ContentHash color = hash_of(frame.grey);
  const io::ContentHash depth = hash_of(frame.depth_m);
  const Novelty novelty{color != color_ || is_uniform(frame.grey),
                        depth != depth_ || is_uniform(frame.depth_m)};
  color_ = color;
  depth_ = depth;
  return novelty;
}

}  // namespace fusebench::core
