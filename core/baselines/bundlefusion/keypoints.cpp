#include "core/baselines/bundlefusion/keypoints.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <tuple>

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr int kOctaves = 4;  // from the octave of the original size on
// The library searches an image of twice the size, where the centre of pixel x is at 2 x + 1/2, and halves
// the coordinates of the result.
constexpr float kShift_px = 0.25F;

/// The library stores the octave in the lowest byte as a signed number; -1 is the image of twice the size.
int octave_of(const cv::KeyPoint& key) { return static_cast<std::int8_t>(key.octave & 0xFF); }

/// Standard deviation of the Gaussian; the library returns twice that.
double scale_px(const cv::KeyPoint& key) { return 0.5 * static_cast<double>(key.size); }

/// Depth at the nearest pixel.
double depth_at_m(const cv::KeyPoint& key, const DepthImage& depth_m) {
  const auto x = static_cast<int>(std::lround(key.pt.x));
  const auto y = static_cast<int>(std::lround(key.pt.y));
  return depth_m.contains(x, y) ? static_cast<double>(depth_m(x, y)) : 0.0;
}

/// Strongest first. A total order for equal strengths, so that the order of the library has no effect.
void sort_by_strength(std::vector<cv::KeyPoint>& keys) {
  std::ranges::sort(keys, [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::make_tuple(-a.response, a.pt.y, a.pt.x, a.size, a.angle) <
           std::make_tuple(-b.response, b.pt.y, b.pt.x, b.size, b.angle);
  });
}

SiftDescriptor descriptor_of(const std::uint8_t* values) {
  SiftDescriptor descriptor;
  int squared_norm = 0;
  for (std::size_t i = 0; i < descriptor.values.size(); ++i) {
    descriptor.values[i] = static_cast<std::int16_t>(values[i]);
    squared_norm += static_cast<int>(values[i]) * static_cast<int>(values[i]);
  }
  descriptor.inverse_norm = squared_norm > 0 ? 1.0 / std::sqrt(squared_norm) : 0.0;
  return descriptor;
}

}  // namespace

Keypoints find_keypoints(const GreyImage& grey, const DepthImage& depth_m, const PinholeCamera& camera,
                         int max_count, double min_scale_px) {
  // OpenCV has no read-only view; the data is never written.
  const cv::Mat view(grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.data.data()));
  // Lowe's settings, the defaults of the library: three layers in an octave, contrast, edges and first scale.
  const auto sift = cv::SIFT::create(0, 3, 0.04, 10, 1.6, CV_8U);
  std::vector<cv::KeyPoint> keys;
  sift->detect(view, keys);
  for (cv::KeyPoint& key : keys) key.pt -= {kShift_px, kShift_px};
  std::erase_if(keys, [&](const cv::KeyPoint& key) {
    return octave_of(key) >= kOctaves || scale_px(key) < min_scale_px || !(depth_at_m(key, depth_m) > 0);
  });
  sort_by_strength(keys);
  keys.resize(std::min(keys.size(), static_cast<std::size_t>(max_count)));
  cv::Mat descriptors;
  if (!keys.empty()) sift->compute(view, keys, descriptors);

  Keypoints keypoints;
  keypoints.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Vector2d pixel_px(static_cast<double>(keys[i].pt.x), static_cast<double>(keys[i].pt.y));
    const double z_m = depth_at_m(keys[i], depth_m);
    keypoints.push_back({pixel_px, camera.back_project(pixel_px.x(), pixel_px.y(), z_m),
                         descriptor_of(descriptors.ptr<std::uint8_t>(static_cast<int>(i)))});
  }
  return keypoints;
}

}  // namespace fusebench::baselines::bundlefusion
