#include "datasets/simulator/texture/texture.hpp"

#include "core/base/error.hpp"

namespace fusebench::simulator::texture {

Texture::Texture(const Image<Eigen::Vector3f>& image) : side_(image.width) {
  check(side_ > 0 && image.height == side_ && std::has_single_bit(static_cast<unsigned>(side_)),
        "a texture is square and its side a power of two");
  for (const Eigen::Vector3f& pixel : image.data) texels_.emplace_back(pixel.x(), pixel.y(), pixel.z(), 0.0F);
  levels_.push_back({0, side_});
  for (int side = side_ / 2; side >= 1; side /= 2) {
    const Level fine = levels_.back();
    levels_.push_back({texels_.size(), side});
    const auto texel = [&](int x, int y) {
      return texels_[fine.offset + static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.side) +
                     static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const Eigen::Array4f sum = texel(2 * x, 2 * y) + texel(2 * x + 1, 2 * y) + texel(2 * x, 2 * y + 1) +
                                   texel(2 * x + 1, 2 * y + 1);
        texels_.emplace_back(0.25F * sum);
      }
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
