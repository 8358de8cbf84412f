// Whether a frame was prepared as it should have been, pixel by pixel in double precision, for the programs
// that measure the kernels which do it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/config/groups/frame_config.hpp"
#include "tests/bench/bench_scene.hpp"

namespace fusebench::testing {

/// One level down: 5x5 binomial weights, mirrored without repeating the border.
inline GreyImage halved(const GreyImage& image) {
  constexpr std::array<int, 5> kWeights = {1, 4, 6, 4, 1};
  const auto mirrored = [](int i, int size) { return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i; };
  GreyImage half((image.width + 1) / 2, (image.height + 1) / 2);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      int sum = 0;
      for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
          sum += kWeights[static_cast<std::size_t>(i + 2)] * kWeights[static_cast<std::size_t>(j + 2)] *
                 image(mirrored(2 * x + i, image.width), mirrored(2 * y + j, image.height));
        }
      }
      half(x, y) = static_cast<std::uint8_t>((sum + 128) / 256);
    }
  }
  return half;
}

/// Level 0 is the image, and each other one the plain half of the one before.
inline bool is_pyramid_of(const std::vector<GreyImage>& pyramid, const GreyImage& image) {
  if (pyramid.empty() || pyramid[0].data != image.data) return false;
  for (std::size_t level = 1; level < pyramid.size(); ++level) {
    if (pyramid[level].data != halved(pyramid[level - 1]).data) return false;
  }
  return true;
}

/// What a pixel of a depth image is once it is gated.
inline float gated_plainly(const DepthImage& depth_m, const config::DepthConfig& config, int x, int y) {
  const float z = depth_m(x, y);
  const bool inner = x > 0 && y > 0 && x + 1 < depth_m.width && y + 1 < depth_m.height;
  if (!inner || !(z >= static_cast<float>(config.min_m) && z <= static_cast<float>(config.max_m)))
    return 0.0F;
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      const float neighbour_m = depth_m(u, v);
      if (neighbour_m > 0.0F && std::abs(neighbour_m - z) > static_cast<float>(config.edge_jump) * z)
        return 0.0F;
    }
  }
  return z;
}

/// Every pixel is gated so, most are left, and some are not.
inline bool is_gated(const DepthImage& gated_m, const DepthImage& depth_m,
                     const config::DepthConfig& config) {
  std::size_t measured = 0;
  std::size_t kept = 0;
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      if (gated_m(x, y) != gated_plainly(depth_m, config, x, y)) return false;
      measured += depth_m(x, y) > 0 ? 1U : 0U;
      kept += gated_m(x, y) > 0 ? 1U : 0U;
    }
  }
  return 2 * kept > measured && kept < measured;
}

/// The rolling shutter is compensated: most of its difference from the rendered frame is gone. Only the room
/// has one.
inline bool is_as_rendered(const RgbdFrame& compensated, const BenchScene& scene) {
  double before = 0;
  double after = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < compensated.grey.data.size(); ++i) {
    if (!(compensated.depth_m.data[i] > 0.0F)) continue;
    ++kept;
    before += std::abs(scene.sensed.grey.data[i] - scene.frame.grey.data[i]);
    after += std::abs(compensated.grey.data[i] - scene.frame.grey.data[i]);
  }
  return 2 * kept > compensated.depth_m.data.size() && after < 0.15 * before;
}

/// A pixel of the frame without its motion, by iterations until nothing moves any more.
class PlainCompensation {
 public:
  explicit PlainCompensation(const BenchScene& scene)
      : sensed_(scene.sensed), camera_(scene.camera), timing_(scene.timing), velocity_(scene.velocity) {}

  struct Pixel {
    double depth_m = 0;
    double grey = 0;
    Vector3d color = Vector3d::Zero();
  };
  [[nodiscard]] Pixel at(int x, int y) const {
    const Vector2d target(x, y);
    Pixel result;
    result.depth_m = carried_depth_m(target);
    // To where the point was when its row was read, which depends on the row where it lands.
    const bool known = result.depth_m > 0;
    const Vector3d now = camera_.back_project(x, y, known ? result.depth_m : 1.0);
    Vector2d from = target;
    for (int i = 0; i < kIterations; ++i) {
      const double time_s = row_time_s(from.y(), 0, timing_.color_readout_s);
      const Vector3d moved = known ? Vector3d(now - time_s * velocity_.linear_mps) : now;
      from = camera_.project(so3_exp(-time_s * velocity_.angular_radps) * moved);
    }
    if (!is_inside(from)) result.depth_m = 0;
    result.grey = sample_bilinear(sensed_.grey, clamped(from).x(), clamped(from).y()).value;
    if (!sensed_.color.empty()) result.color = color_at(clamped(from));
    return result;
  }

 private:
  static constexpr int kIterations = 12;

  /// What the depth pixels that their own motion carries to the target measured; 0 = nothing.
  [[nodiscard]] double carried_depth_m(const Vector2d& target) const {
    Vector2d from = target;
    double depth_m = 0;
    for (int i = 0; i < kIterations; ++i) {
      const Vector2d inside = clamped(from);
      const auto x = static_cast<int>(std::lround(inside.x()));
      const auto y = static_cast<int>(std::lround(inside.y()));
      const double measured_m = static_cast<double>(sensed_.depth_m(x, y));
      const double time_s =
          row_time_s(y, seconds_between(0, sensed_.depth_offset_ns), timing_.depth_readout_s);
      const double distance_m = measured_m > 0 ? measured_m : 1.0;
      Vector3d carried =
          so3_exp(time_s * velocity_.angular_radps) * camera_.back_project(from.x(), from.y(), distance_m);
      if (measured_m > 0) carried += time_s * velocity_.linear_mps;
      depth_m = measured_m > 0 ? carried.z() : 0.0;
      from += target - camera_.project(carried);
    }
    return is_inside(from) ? depth_m : 0.0;
  }

  [[nodiscard]] Vector3d color_at(const Vector2d& place) const {
    const int left = std::min(static_cast<int>(place.x()), camera_.width_px - 2);
    const int top = std::min(static_cast<int>(place.y()), camera_.height_px - 2);
    const Vector2d share = place - Vector2d(left, top);
    const auto row = [&](int y) {
      const auto pixel = [&](int x) {
        const Rgb& rgb = sensed_.color(x, y);
        return Vector3d(rgb[0], rgb[1], rgb[2]);
      };
      return Vector3d(pixel(left) + share.x() * (pixel(left + 1) - pixel(left)));
    };
    return row(top) + share.y() * (row(top + 1) - row(top));
  }

  [[nodiscard]] double row_time_s(double row, double delay_s, double readout_s) const {
    const double last = camera_.height_px - 1;
    return delay_s + (std::clamp(row, 0.0, last) / last - 0.5) * readout_s;
  }
  [[nodiscard]] bool is_inside(const Vector2d& pixel) const { return (clamped(pixel) - pixel).norm() < 1e-3; }
  [[nodiscard]] Vector2d clamped(const Vector2d& pixel) const {
    return {std::clamp(pixel.x(), 0.0, camera_.width_px - 1.0),
            std::clamp(pixel.y(), 0.0, camera_.height_px - 1.0)};
  }

  const RgbdFrame& sensed_;
  const PinholeCamera& camera_;
  const SensorTiming& timing_;
  const preprocessing::CameraVelocity& velocity_;
};

/// Nearly every pixel that is looked at is the same, as same(x, y, expected) says of it and of what the plain
/// iterations find. Looked at are those where there is depth of a mask, or all.
template <class Same>
bool is_nearly_plain(const BenchScene& scene, const DepthImage* mask_m, const Same& same) {
  constexpr int kStep_px = 5;
  const PlainCompensation plain(scene);
  int looked_at = 0;
  int alike = 0;
  for (int y = 0; y < scene.camera.height_px; y += kStep_px) {
    for (int x = 0; x < scene.camera.width_px; x += kStep_px) {
      if (mask_m != nullptr && !((*mask_m)(x, y) > 0.0F)) continue;
      ++looked_at;
      alike += same(x, y, plain.at(x, y)) ? 1 : 0;
    }
  }
  return looked_at > 0 && alike > 0.95 * looked_at;
}

/// At edges of depth there may be two answers.
inline bool is_compensated(const RgbdFrame& compensated, const BenchScene& scene) {
  return is_nearly_plain(scene, nullptr, [&](int x, int y, const PlainCompensation::Pixel& expected) {
    return std::abs(static_cast<double>(compensated.depth_m(x, y)) - expected.depth_m) < 1e-3 &&
           std::abs(compensated.grey(x, y) - expected.grey) < 1.5;
  });
}

/// The same of colour, where there is depth.
inline bool is_color_compensated(const ColorImage& color, const DepthImage& depth_m,
                                 const BenchScene& scene) {
  return is_nearly_plain(scene, &depth_m, [&](int x, int y, const PlainCompensation::Pixel& expected) {
    const Rgb& rgb = color(x, y);
    return (Vector3d(rgb[0], rgb[1], rgb[2]) - expected.color).cwiseAbs().maxCoeff() < 1.5;
  });
}

}  // namespace fusebench::testing
