// Depth by structured light, the model of the noisy ICL-NUIM sequences: Handa, Whelan, McDonald, Davison, "A
// benchmark for RGB-D visual odometry, 3D reconstruction and SLAM", ICRA 2014, with constants from the
// authors' published code (github.com/ankurhanda/simkinect, add_noise.py, commit 1106ad0):
//   1. each pixel looks at its depth bilinearly at a place shifted by N(0, (1/2 px)^2) in u and v;
//   2. disparity f B / z with B = 0.075 m and the camera's f (480 px there), rounded to 1/8 px;
//   3. disparity is measured where the projector has a dot, if within 9 x 9 pixels more than 1/1.2 of
//      the dots agree with the window's mean within 0.1 px times 1.44 r^2 (r: pixels from the centre, at
//      least the centre itself to 0.1 px); other pixels take the disparity of the nearest dot within 3 px,
//      so depth edges have holes and fattened rims, and surfaces seen obliquely have holes;
//   4. z = 35130 / round(35130 / round(100 z) + N(0, (1/6)^2)) / 100, which is Barron & Malik's: 35130
//      are the Kinect's focal length, baseline and 1/8 px in centimetres. (The published code rounds
//      after it has added 0.5, which would move every depth towards the camera by half a step; that is
//      left out.)
// Pixels are the sensor's (native_pixels.hpp). Assumptions of ours: the dots (one a 3 x 3 cell, at a place
// from a hash; the published pattern is an image), and that nothing is measured on surfaces seen at more than
// 80 degrees, where a dot is stretched beyond recognition.
#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/sensors/depth_noise.hpp"

namespace fusebench::simulator::sensors {

namespace {

constexpr double kBaseline_m = 0.075;
constexpr float kStepsPerPixel = 8;
constexpr float kShift_px = 0.5F;
constexpr float kFillRadius_px = 3;
constexpr float kWindowTolerance_px = 0.1F;
constexpr float kTolerancePerRadius2 = 1.44F;
constexpr float kAgreement = 1.0F / 1.2F;
constexpr double kKinectSteps_cm = 35130;
constexpr double kStepNoise = 1.0 / 6.0;
constexpr float kMinCosine = 0.1736F;  // 80 degrees

constexpr std::uint64_t kShiftNoise = 1;
constexpr std::uint64_t kStepNoiseKey = 2;
constexpr std::uint64_t kDots = 0xD075;  // the pattern is the same in all images

/// Lengths of step 3 in pixels of the image, for any image size.
struct Lengths {
  explicit Lengths(const NativePixels& native)
      : native_px(static_cast<float>(native.per_image_px())),
        half_window(native.in_image(4)),
        cell(native.in_image(3)),
        cells_around(half_window / cell + 1) {}

  float native_px;  ///< sensor pixels per image pixel
  int half_window;
  int cell;          ///< one dot per cell; the fill radius reaches neighbouring cells only
  int cells_around;  ///< that a window can reach
};

/// Steps 1 and 2. Disparity is 0 beyond an open edge or on a surface that is too oblique.
DepthImage quantised_disparity(const Image<render::Renderer::Surface>& surfaces, float focal_baseline,
                               float shift_px, std::uint64_t key, const Workers& workers) {
  DepthImage disparity_px(surfaces.width, surfaces.height);
  const random::NormalTable& normal = random::NormalTable::instance();
  workers.for_rows(surfaces.height, [&](int v) {
    for (int u = 0; u < surfaces.width; ++u) {
      const std::array<float, 3> shift = normal.triple(random::mix_key(key, surfaces.index(u, v)));
      const float x = std::clamp(static_cast<float>(u) + shift_px * shift[0], 0.0F,
                                 static_cast<float>(surfaces.width - 1));
      const float y = std::clamp(static_cast<float>(v) + shift_px * shift[1], 0.0F,
                                 static_cast<float>(surfaces.height - 1));
      const int x0 = std::min(static_cast<int>(x), std::max(0, surfaces.width - 2));
      const int y0 = std::min(static_cast<int>(y), std::max(0, surfaces.height - 2));
      const int x1 = std::min(x0 + 1, surfaces.width - 1);
      const int y1 = std::min(y0 + 1, surfaces.height - 1);
      const std::array<const render::Renderer::Surface*, 4> corners = {&surfaces(x0, y0), &surfaces(x1, y0),
                                                                       &surfaces(x0, y1), &surfaces(x1, y1)};
      const bool open = std::ranges::any_of(corners, [](const auto* s) { return s->depth_m <= 0; });
      if (open || surfaces(u, v).cos_incidence < kMinCosine) continue;
      const float fx = x - static_cast<float>(x0);
      const float fy = y - static_cast<float>(y0);
      const float top = corners[0]->depth_m + fx * (corners[1]->depth_m - corners[0]->depth_m);
      const float bottom = corners[2]->depth_m + fx * (corners[3]->depth_m - corners[2]->depth_m);
      const float depth_m = top + fy * (bottom - top);
      disparity_px(u, v) = std::round(focal_baseline / depth_m * kStepsPerPixel) / kStepsPerPixel;
    }
  });
  return disparity_px;
}

struct Dot {
  int u = 0;
  int v = 0;
};

/// The pattern of the projector: the dot of each cell.
Image<Dot> dot_pattern(int width, int height, int cell) {
  Image<Dot> dots(width / cell, height / cell);
  const auto size = static_cast<std::uint64_t>(cell);
  for (int row = 0; row < dots.height; ++row) {
    for (int column = 0; column < dots.width; ++column) {
      const std::uint64_t bits = random::mix_key(kDots, dots.index(column, row));
      dots(column, row) = {cell * column + static_cast<int>(bits % size),
                           cell * row + static_cast<int>((bits >> 32) % size)};
    }
  }
  return dots;
}

/// Sums over row windows: of disparities, and of measured pixels.
struct RowSums {
  DepthImage disparity_px;
  Image<float> measured;

  RowSums(const DepthImage& of, int distance, const Workers& workers)
      : disparity_px(of.width, of.height), measured(of.width, of.height) {
    workers.for_rows(of.height, [&](int v) {
      for (int shift = -distance; shift <= distance; ++shift) {
        for (int u = std::max(0, -shift); u < std::min(of.width, of.width - shift); ++u) {
          disparity_px(u, v) += of(u + shift, v);
          measured(u, v) += of(u + shift, v) > 0 ? 1.0F : 0.0F;
        }
      }
    });
  }
};

/// Step 3 for one dot: its disparity, or 0 if the window does not agree. sums: over half the window to either
/// side.
float measured_at(const DepthImage& disparity_px, const RowSums& sums, const Lengths& lengths,
                  const Image<Dot>& dots, const Dot& dot) {
  const int half = lengths.half_window;
  if (!disparity_px.contains(dot.u - half, dot.v - half) ||
      !disparity_px.contains(dot.u + half, dot.v + half)) {
    return 0;
  }
  const float centre = disparity_px(dot.u, dot.v);
  if (centre <= 0) return 0;
  float sum = 0;
  float valid = 0;
  for (int v = dot.v - half; v <= dot.v + half; ++v) {
    sum += sums.disparity_px(dot.u, v);
    valid += sums.measured(dot.u, v);
  }
  const float mean = sum / valid;
  int seen = 0;
  int agreeing = 0;
  for (int row = dot.v / lengths.cell - lengths.cells_around;
       row <= dot.v / lengths.cell + lengths.cells_around; ++row) {
    for (int column = dot.u / lengths.cell - lengths.cells_around;
         column <= dot.u / lengths.cell + lengths.cells_around; ++column) {
      if (!dots.contains(column, row)) continue;
      const Dot other = dots(column, row);
      const int du = other.u - dot.u;
      const int dv = other.v - dot.v;
      if (std::abs(du) > half || std::abs(dv) > half) continue;
      ++seen;
      const float d = disparity_px(other.u, other.v);
      const float radius2 = static_cast<float>(du * du + dv * dv) * lengths.native_px * lengths.native_px;
      const float tolerance = kWindowTolerance_px * (radius2 > 0 ? kTolerancePerRadius2 * radius2 : 1.0F);
      if (d > 0 && std::abs(d - mean) < tolerance) ++agreeing;
    }
  }
  return static_cast<float>(agreeing) > kAgreement * static_cast<float>(seen) ? centre : 0.0F;
}

/// For each pixel, the disparity of the nearest measured dot (the first on a tie); 0 if none is within reach.
DepthImage filled_from(const DepthImage& dots_px, const Lengths& lengths, const Image<Dot>& dots, int width,
                       int height) {
  const float fill_radius2 = std::pow(kFillRadius_px / lengths.native_px, 2.0F);
  const int reach = static_cast<int>(kFillRadius_px / lengths.native_px);
  Image<float> nearest2(width, height, fill_radius2);
  DepthImage filled(width, height);
  for (std::size_t i = 0; i < dots.data.size(); ++i) {
    if (dots_px.data[i] <= 0) continue;
    const Dot& dot = dots.data[i];
    for (int v = std::max(0, dot.v - reach); v <= std::min(height - 1, dot.v + reach); ++v) {
      for (int u = std::max(0, dot.u - reach); u <= std::min(width - 1, dot.u + reach); ++u) {
        const auto distance2 = static_cast<float>((dot.u - u) * (dot.u - u) + (dot.v - v) * (dot.v - v));
        if (distance2 > nearest2(u, v) || (distance2 == nearest2(u, v) && filled(u, v) > 0)) continue;
        nearest2(u, v) = distance2;
        filled(u, v) = dots_px.data[i];
      }
    }
  }
  return filled;
}

/// Step 4.
float kinect_depth_m(float depth_m, float noise) {
  const double centimetres = std::max(1.0, std::round(100.0 * static_cast<double>(depth_m)));
  const double steps = std::round(kKinectSteps_cm / centimetres + kStepNoise * static_cast<double>(noise));
  return steps >= 1 ? static_cast<float>(kKinectSteps_cm / steps / 100.0) : 0.0F;
}

}  // namespace

DepthImage structured_light_depth(const Image<render::Renderer::Surface>& surfaces,
                                  const NativePixels& native, std::uint64_t key, const Workers& workers) {
  const float focal_baseline = native.focal_baseline_px_m(kBaseline_m);
  const Lengths lengths(native);
  const DepthImage disparity_px = quantised_disparity(surfaces, focal_baseline, kShift_px / lengths.native_px,
                                                      random::mix_key(key, kShiftNoise), workers);
  const Image<Dot> dots = dot_pattern(surfaces.width, surfaces.height, lengths.cell);
  const RowSums sums(disparity_px, lengths.half_window, workers);
  DepthImage dots_px(dots.width, dots.height);
  workers.for_rows(dots_px.height, [&](int row) {
    for (int column = 0; column < dots_px.width; ++column) {
      dots_px(column, row) = measured_at(disparity_px, sums, lengths, dots, dots(column, row));
    }
  });
  const DepthImage filled_px = filled_from(dots_px, lengths, dots, surfaces.width, surfaces.height);
  const random::NormalTable& normal = random::NormalTable::instance();
  const std::uint64_t step_key = random::mix_key(key, kStepNoiseKey);
  DepthImage depth_m(surfaces.width, surfaces.height);
  workers.for_rows(depth_m.height, [&](int v) {
    for (int u = 0; u < depth_m.width; ++u) {
      const float disparity = filled_px(u, v);
      if (disparity <= 0) continue;
      depth_m(u, v) =
          kinect_depth_m(focal_baseline / disparity, normal(random::mix_key(step_key, depth_m.index(u, v))));
    }
  });
  return depth_m;
}

}  // namespace fusebench::simulator::sensors
