#include "core/baselines/elasticfusion/surfels/surfel_measure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

constexpr float kRadialVariance = 0.72F;  // 2 * 0.6^2
constexpr double kFullMotion = 0.01;      // metres or radians a frame
constexpr double kLeastMotionWeight = 0.5;
constexpr float kMostGrowth = 1.5F;  // larger measurements have less detail

}  // namespace

float radius_of(float depth_m, float normal_z, const PinholeCamera& camera) {
  const auto focal = static_cast<float>(0.5 * (camera.fx_px + camera.fy_px));
  const float front = std::numbers::sqrt2_v<float> * depth_m / focal;
  return front / std::max(0.5F, std::abs(normal_z));
}

float weight_of_motion(const SE3& T_before_camera) {
  const double motion =
      std::max(T_before_camera.translation.norm(), so3_log(T_before_camera.rotation).norm());
  return static_cast<float>(std::max(1 - std::min(motion, kFullMotion) / kFullMotion, kLeastMotionWeight));
}

float confidence_of(int x_px, int y_px, const PinholeCamera& camera, float motion_weight) {
  const double half_diagonal = 0.5 * std::hypot(camera.width_px, camera.height_px);
  const auto radius =
      static_cast<float>(std::hypot(x_px - camera.cx_px, y_px - camera.cy_px) / half_diagonal);
  return motion_weight * std::exp(-radius * radius / kRadialVariance);
}

Surfel merged(const Surfel& known, const Surfel& measured) {
  Surfel result = known;
  result.confidence = known.confidence + measured.confidence;
  result.updated = measured.updated;
  if (measured.radius_m >= kMostGrowth * known.radius_m) return result;
  const float share = measured.confidence / result.confidence;
  result.position += share * (measured.position - known.position);
  result.normal = ((1 - share) * known.normal + share * measured.normal).normalized();
  result.radius_m += share * (measured.radius_m - known.radius_m);
  for (std::size_t channel = 0; channel < result.color.size(); ++channel) {
    const auto old = static_cast<float>(known.color[channel]);
    const auto seen = static_cast<float>(measured.color[channel]);
    result.color[channel] = static_cast<std::uint8_t>(std::lround(old + share * (seen - old)));
  }
  return result;
}

}  // namespace fusebench::baselines::elasticfusion::surfels
