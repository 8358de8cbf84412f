#include "datasets/simulator/texture/texture.hpp"

#include <utility>

#include "core/base/error.hpp"

namespace fusebench::simulator::texture {

Texture::Texture(const Image<Eigen::Vector3f>& image) : side_(image.width) {
  check(side_ > 0 && image.height == side_ && std::has_single_bit(static_cast<unsigned>(side_)),
        "a texture is square and its side a power of two");
  add_level(image);
  Image<Eigen::Vector3f> fine = image;
  for (int side = side_ / 2; side >= 1; side /= 2) {
    Image<Eigen::Vector3f> coarse(side, side);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        coarse(x, y) = 0.25F * (fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y) + fine(2 * x, 2 * y + 1) +
                                fine(2 * x + 1, 2 * y + 1));
      }
    }
    add_level(coarse);
    fine = std::move(coarse);
  }
}

void Texture::add_level(const Image<Eigen::Vector3f>& image) {
  offsets_.push_back(static_cast<std::int32_t>(texels_.size()));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x <= image.width; ++x) {
      for (const float channel : image(x % image.width, y)) texels_.emplace_back(channel);
      texels_.emplace_back(0.0F);
    }
  }
}

double srgb_from_linear(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace fusebench::simulator::texture
