#include "core/repeated_images.hpp"

#include <string_view>

namespace fusebench::core {

namespace {

template <class Pixel>
io::ContentHash hash_of(const Image<Pixel>& image) {
  return io::content_hash(
      std::string_view(reinterpret_cast<const char*>(image.data.data()), image.data.size() * sizeof(Pixel)));
}

}  // namespace

Novelty RepeatedImages::examine(const RgbdFrame& frame) {
  const io::ContentHash color = hash_of(frame.grey);
  const io::ContentHash depth = hash_of(frame.depth_m);
  const Novelty novelty{color != color_, depth != depth_};
  color_ = color;
  depth_ = depth;
  return novelty;
}

}  // namespace fusebench::core
