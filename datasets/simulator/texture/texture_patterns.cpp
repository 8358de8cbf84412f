#include "datasets/simulator/texture/texture_patterns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/texture/texture.hpp"

namespace fusebench::simulator::texture {

namespace {

using Color = Eigen::Vector3f;

/// Colours of furniture.
constexpr std::array<std::uint32_t, 14> kPalette = {0x8c2f2b, 0x1f4e79, 0x2f6b4f, 0xd9a441, 0xe8e2d0,
                                                    0x3b3b46, 0xb5651d, 0x6a4c93, 0x4f8a8b, 0xc94f4f,
                                                    0x283845, 0xf2c14e, 0x7d8471, 0xdfd3c3};

Color palette_color(std::uint64_t bits) { return reflectance_of(kPalette[bits % kPalette.size()]); }

float random_unit(std::uint64_t seed, std::uint64_t counter) {
  return static_cast<float>(random::unit_interval(random::mix_key(seed, counter)));
}

Color blend(const Color& a, const Color& b, float t) { return a + t * (b - a); }

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

float fraction(float x) { return x - std::floor(x); }

/// Distance to the nearest integer.
float to_integer(float x) { return std::abs(x - std::round(x)); }

template <class Shade>
ReflectanceImage paint(int side, const Shade& shade) {
  ReflectanceImage image(side, side, Color::Zero());
  const float step = 1.0F / static_cast<float>(side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Color color = shade((static_cast<float>(x) + 0.5F) * step, (static_cast<float>(y) + 0.5F) * step);
      image(x, y) = color.cwiseMax(0.005F).cwiseMin(0.95F);
    }
  }
  return image;
}

/// A shape of a picture: a disc, a box or a ring.
struct Shape {
  int kind = 0;
  Eigen::Vector2f centre;
  Eigen::Vector2f half;
  float turn = 0;
  Color color;

  static Shape random(random::RandomSequence& random) {
    const auto f = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    Shape shape;
    shape.kind = random.below(3);
    shape.centre = {f(0, 1), f(0, 1)};
    shape.half = {f(0.03, 0.2), f(0.03, 0.2)};
    shape.turn = f(0, 3.1);
    shape.color = palette_color(random.bits());
    return shape;
  }
  [[nodiscard]] bool covers(float u, float v) const {
    const float x = u - centre.x();
    const float y = v - centre.y();
    const float a = std::cos(turn) * x + std::sin(turn) * y;
    const float b = std::cos(turn) * y - std::sin(turn) * x;
    if (kind == 0) return a * a + b * b < half.x() * half.x();
    if (kind == 1) return std::abs(a) < half.x() && std::abs(b) < half.y();
    return std::abs(std::sqrt(a * a + b * b) - half.x()) < 0.15F * half.y() + 0.008F;
  }
};

}  // namespace

Color reflectance_of(std::uint32_t srgb) {
  const auto channel = [&](unsigned shift) {
    return static_cast<float>(linear_from_srgb(static_cast<double>((srgb >> shift) & 255U) / 255.0));
  };
  return {channel(16), channel(8), channel(0)};
}

float TorusNoise::operator()(float u, float v) const {
  float sum = 0;
  float total = 0;
  float weight = 1;
  int period = cells;
  for (int octave = 0; octave < octaves; ++octave) {
    const float x = fraction(u) * static_cast<float>(period);
    const float y = fraction(v) * static_cast<float>(period);
    const int x0 = static_cast<int>(x);
    const int y0 = static_cast<int>(y);
    const auto corner = [&](int i, int j) {
      const auto cell = static_cast<std::uint64_t>(((y0 + j) % period) * period + (x0 + i) % period);
      return random_unit(seed + static_cast<std::uint64_t>(octave), cell);
    };
    const float fx = smooth_step(0, 1, x - static_cast<float>(x0));
    const float fy = smooth_step(0, 1, y - static_cast<float>(y0));
    const float top = corner(0, 0) + fx * (corner(1, 0) - corner(0, 0));
    const float bottom = corner(0, 1) + fx * (corner(1, 1) - corner(0, 1));
    sum += weight * (top + fy * (bottom - top));
    total += weight;
    weight *= gain;
    period *= 2;
  }
  return sum / total;
}

ReflectanceImage paint_plain(const Color& color) {
  return paint(8, [&](float, float) { return color; });
}

ReflectanceImage paint_plaster(int side, const Color& color, float contrast, std::uint64_t seed) {
  const TorusNoise rough{.seed = seed, .cells = 4, .octaves = 6, .gain = 0.8F};
  return paint(
      side, [&](float u, float v) -> Color { return color * (1 + contrast * 2.4F * (rough(u, v) - 0.5F)); });
}

ReflectanceImage paint_wood(int side, const Color& light, const Color& dark, int boards, std::uint64_t seed) {
  const TorusNoise wave{.seed = seed, .cells = 2, .octaves = 4, .gain = 0.5F};
  const TorusNoise fibre{.seed = seed + 50, .cells = 64, .octaves = 2, .gain = 0.7F};
  return paint(side, [&](float u, float v) {
    const float across = v * static_cast<float>(boards);
    const auto board = static_cast<std::uint64_t>(across);
    const float shade = random_unit(seed, board);
    const float along = fraction(u + random_unit(seed + 1, board));  // joints are staggered
    const float rings = 9 * (wave(along, 0.35F * v + 0.3F * shade) + 0.15F * v) + 3 * shade;
    const float grain = 0.55F * to_integer(rings) * 2 + 0.45F * fibre(0.125F * along, v);
    Color color = blend(light, dark, std::clamp(0.15F + 0.65F * grain + 0.35F * (shade - 0.5F), 0.0F, 1.0F));
    const bool joint = to_integer(across) < 0.018F || to_integer(along) < 0.003F;
    if (boards > 1 && joint) color *= 0.25F;
    return color;
  });
}

ReflectanceImage paint_bricks(int side, const Color& brick, const Color& mortar, std::uint64_t seed) {
  const TorusNoise rough{.seed = seed, .cells = 16, .octaves = 4, .gain = 0.7F};
  return paint(side, [&](float u, float v) {
    const float row = 8 * v;
    const auto course = static_cast<std::uint64_t>(row);
    const float along = 4 * u + (course % 2 == 0 ? 0.0F : 0.5F);
    const auto index = static_cast<std::uint64_t>(along) % 4;
    const float noise = rough(u, v);
    const float gap = 0.05F + 0.03F * noise;
    if (to_integer(row) < gap || to_integer(along) < 0.5F * gap) return Color(mortar * (0.6F + 0.6F * noise));
    const float shade = 0.55F + 0.7F * random_unit(seed + 9, course * 8 + index);
    return Color(brick * (shade * (0.5F + noise)));
  });
}

ReflectanceImage paint_tiles(int side, const Color& first, const Color& second, int count,
                             std::uint64_t seed) {
  const TorusNoise veins{.seed = seed, .cells = 8, .octaves = 5, .gain = 0.75F};
  return paint(side, [&](float u, float v) {
    const float x = u * static_cast<float>(count);
    const float y = v * static_cast<float>(count);
    if (std::min(to_integer(x), to_integer(y)) < 0.025F) return Color(Color::Constant(0.12F));
    const bool odd = (static_cast<int>(x) + static_cast<int>(y)) % 2 == 1;
    return Color((odd ? second : first) * (0.55F + 0.9F * veins(u, v)));
  });
}

ReflectanceImage paint_wallpaper(int side, const Color& ground, const Color& figure, std::uint64_t seed) {
  const TorusNoise rough{.seed = seed, .cells = 32, .octaves = 3, .gain = 0.8F};
  return paint(side, [&](float u, float v) {
    const float x = 6 * u;
    const bool ornate = static_cast<int>(x) % 2 == 0;
    const float dx = fraction(x) - 0.5F;
    const float dy = (fraction(8 * v) - 0.5F) * 0.75F;
    const float radius = std::sqrt(dx * dx + dy * dy);
    const float petals = 0.24F + 0.1F * std::cos(5 * std::atan2(dy, dx));
    Color color = ornate ? ground : blend(ground, figure, 0.25F);
    if (ornate && radius < petals) color = figure;
    if (ornate && radius < 0.09F) color = ground;
    if (to_integer(x) < 0.03F) color = blend(figure, ground, 0.3F);
    return Color(color * (0.75F + 0.5F * rough(u, v)));
  });
}

ReflectanceImage paint_fabric(int side, const Color& color, const Color& stripe, std::uint64_t seed) {
  const TorusNoise rough{.seed = seed, .cells = 8, .octaves = 5, .gain = 0.85F};
  return paint(side, [&](float u, float v) {
    const float thread =
        0.5F + 0.25F * (std::sin(2 * 3.14159265F * 48 * u) + std::sin(2 * 3.14159265F * 48 * v));
    const float band = fraction(4 * u);
    const bool striped = band < 0.12F || (band > 0.2F && band < 0.24F) || fraction(4 * v) < 0.07F;
    return Color((striped ? stripe : color) * (0.45F + 0.35F * thread + 0.75F * rough(u, v)));
  });
}

ReflectanceImage paint_rug(int side, const Color& ground, const Color& figure, std::uint64_t seed) {
  const TorusNoise pile{.seed = seed, .cells = 32, .octaves = 4, .gain = 0.9F};
  const Color accent = palette_color(random::mix_bits(seed));
  return paint(side, [&](float u, float v) {
    const float edge = std::min(std::min(u, 1 - u), std::min(v, 1 - v));
    const float x = std::abs(u - 0.5F);
    const float y = std::abs(v - 0.5F);
    Color color = ground;
    const float diamonds = to_integer(7 * (x + y)) + 0.35F * to_integer(9 * (x - y));
    if (diamonds < 0.2F) color = figure;
    if (std::abs(x + 1.3F * y - 0.25F) < 0.03F || x * x + y * y < 0.012F) color = accent;
    if (edge < 0.13F) color = to_integer(14 * u) + to_integer(14 * v) < 0.45F ? figure : accent;
    if (edge < 0.02F || (edge > 0.13F && edge < 0.145F)) color = 0.4F * ground;
    return Color(color * (0.55F + 0.9F * pile(u, v)));
  });
}

ReflectanceImage paint_picture(int side, std::uint64_t seed) {
  random::RandomSequence random(seed);
  const Color top = palette_color(random.bits());
  const Color bottom = palette_color(random.bits());
  std::vector<Shape> shapes;
  for (int i = 0; i < 26; ++i) shapes.push_back(Shape::random(random));
  const TorusNoise brush{.seed = random.bits(), .cells = 8, .octaves = 5, .gain = 0.8F};
  return paint(side, [&](float u, float v) {
    Color color = blend(bottom, top, v);
    for (const Shape& shape : shapes) {
      if (shape.covers(u, v)) color = shape.color;
    }
    return Color(color * (0.6F + 0.8F * brush(u, v)));
  });
}

ReflectanceImage paint_page(int side, std::uint64_t seed) {
  constexpr int kLines = 30;
  const Color ink = reflectance_of(0x22242c);
  const Color paper = reflectance_of(0xe9e5da);
  const Shape figure = [&] {
    random::RandomSequence random(seed);
    Shape shape = Shape::random(random);
    shape.kind = 1;
    shape.turn = 0;
    shape.centre = {0.6F, 0.35F};
    shape.half = {0.25F, 0.12F};
    return shape;
  }();
  const TorusNoise print{.seed = seed + 3, .cells = 16, .octaves = 3, .gain = 0.8F};
  return paint(side, [&](float u, float v) {
    const auto line = static_cast<std::uint64_t>(v * kLines);
    const float within = fraction(v * kLines);
    if (figure.covers(u, v)) return Color(figure.color * (0.3F + 1.3F * print(u, v)));
    const bool margin = u < 0.08F || u > 0.92F || line < 1 || line > kLines - 3;
    const bool heading = line == kLines - 4 && u < 0.6F;
    const bool ended = line % 7 == 0 && u > 0.2F + 0.6F * random_unit(seed, line);
    const auto letter = static_cast<std::uint64_t>(u * (heading ? 40 : 70));
    const bool space = random_unit(seed + line, letter / 2) < 0.22F;
    const bool stroke =
        within > 0.2F && within < (heading ? 0.95F : 0.7F) && random_unit(seed + 7 * line, letter) < 0.75F;
    return !margin && !ended && !space && stroke ? ink : paper;
  });
}

ReflectanceImage paint_speckles(int side, const Color& ground, const Color& speck, std::uint64_t seed) {
  const TorusNoise stains{.seed = seed, .cells = 4, .octaves = 4, .gain = 0.7F};
  const TorusNoise grains{.seed = seed + 20, .cells = 48, .octaves = 2, .gain = 0.9F};
  return paint(side, [&](float u, float v) {
    const float coverage = smooth_step(0.6F, 0.66F, grains(u, v) + 0.3F * (stains(u, v) - 0.5F));
    return Color(blend(ground, speck, coverage) * (0.75F + 0.5F * stains(u, v)));
  });
}

ReflectanceImage paint_spines(int side, std::uint64_t seed) {
  constexpr int kBands = 16;
  const TorusNoise wear{.seed = seed, .cells = 16, .octaves = 4, .gain = 0.8F};
  return paint(side, [&](float u, float v) {
    const auto band = static_cast<std::uint64_t>(u * kBands);
    const std::uint64_t bits = random::mix_key(seed, band);
    const Color cover = palette_color(bits);
    const Color print = palette_color(bits >> 8);
    const float across = fraction(u * kBands);
    const auto letter = static_cast<std::uint64_t>(v * 64);
    const bool lettering = across > 0.3F && across < 0.7F && random_unit(bits, letter / 9) < 0.5F &&
                           random_unit(bits + 1, letter) < 0.7F;
    const bool ring = to_integer(5 * v + random_unit(bits, 99)) < 0.035F;
    return Color((lettering || ring ? print : cover) * (0.6F + 0.8F * wear(u, v)));
  });
}

}  // namespace fusebench::simulator::texture
