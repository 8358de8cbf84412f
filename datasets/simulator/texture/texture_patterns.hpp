// Generated periodic reflectance images for surfaces. All are functions of their arguments alone.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/image.hpp"

namespace fusebench::simulator::texture {

using ReflectanceImage = Image<Eigen::Vector3f>;  ///< linear, 0 to 1, square, side a power of two

/// Linear reflectance of an sRGB colour 0xRRGGBB.
[[nodiscard]] Eigen::Vector3f reflectance_of(std::uint32_t srgb);

/// Value noise in [0, 1] on a torus: `cells` lattice cells per repeat, then `octaves` with doubled frequency,
/// each with the amplitude of the previous one times `gain`. u and v in repeats.
struct TorusNoise {
  std::uint64_t seed = 0;
  int cells = 4;
  int octaves = 5;
  float gain = 0.6F;

  [[nodiscard]] float operator()(float u, float v) const;
};

/// A uniform colour, without trackable texture.
[[nodiscard]] ReflectanceImage paint_plain(const Eigen::Vector3f& color);
/// Rough paint: noise over many scales; contrast 0 to 1.
[[nodiscard]] ReflectanceImage paint_plaster(int side, const Eigen::Vector3f& color, float contrast,
                                             std::uint64_t seed);
/// Boards with grain along u; `boards` per repeat, of different shades, with dark joints if there are
/// several.
[[nodiscard]] ReflectanceImage paint_wood(int side, const Eigen::Vector3f& light, const Eigen::Vector3f& dark,
                                          int boards, std::uint64_t seed);
/// Courses of bricks, 4 by 8 per repeat.
[[nodiscard]] ReflectanceImage paint_bricks(int side, const Eigen::Vector3f& brick,
                                            const Eigen::Vector3f& mortar, std::uint64_t seed);
/// Square tiles of two shades with joints; count even.
[[nodiscard]] ReflectanceImage paint_tiles(int side, const Eigen::Vector3f& first,
                                           const Eigen::Vector3f& second, int count, std::uint64_t seed);
/// Wallpaper: stripes along v with a row of ornaments on every second one.
[[nodiscard]] ReflectanceImage paint_wallpaper(int side, const Eigen::Vector3f& ground,
                                               const Eigen::Vector3f& figure, std::uint64_t seed);
/// Woven cloth: threads, noise, and coloured stripes.
[[nodiscard]] ReflectanceImage paint_fabric(int side, const Eigen::Vector3f& color,
                                            const Eigen::Vector3f& stripe, std::uint64_t seed);
/// A rug with a border and an ornament; not periodic.
[[nodiscard]] ReflectanceImage paint_rug(int side, const Eigen::Vector3f& ground,
                                         const Eigen::Vector3f& figure, std::uint64_t seed);
/// A picture: overlapping shapes on a colour gradient.
[[nodiscard]] ReflectanceImage paint_picture(int side, std::uint64_t seed);
/// A printed page: a heading, lines of words, a figure.
[[nodiscard]] ReflectanceImage paint_page(int side, std::uint64_t seed);
/// Stone with specks.
[[nodiscard]] ReflectanceImage paint_speckles(int side, const Eigen::Vector3f& ground,
                                              const Eigen::Vector3f& speck, std::uint64_t seed);
/// Coloured bands with bars similar to lettering, for the spines of books and the sides of boxes.
[[nodiscard]] ReflectanceImage paint_spines(int side, std::uint64_t seed);

}  // namespace fusebench::simulator::texture
