#include "datasets/simulator/motion/motion_heading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fusebench::simulator::motion {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStep_rad = kTurn / HeadingTexture::kHeadings;
constexpr PinholeCamera kViewer = {96, 72, 90, 90, 47.5, 35.5};
constexpr int kCell_px = 8;
constexpr float kEdge = 6.0F / 255.0F;  // difference of neighbours above the noise of a sensor

/// Approximate encoded brightness: differences of light count more in the dark.
float brightness(const Eigen::Vector3f& light) { return std::sqrt(std::max(0.0F, light.mean())); }

bool holds_edge(const Image<Eigen::Vector3f>& light, int left, int top) {
  for (int v = top; v < top + kCell_px - 1; ++v) {
    for (int u = left; u < left + kCell_px - 1; ++u) {
      const float here = brightness(light(u, v));
      if (std::abs(brightness(light(u + 1, v)) - here) > kEdge) return true;
      if (std::abs(brightness(light(u, v + 1)) - here) > kEdge) return true;
    }
  }
  return false;
}

double share_of_edges(const Image<Eigen::Vector3f>& light) {
  int cells = 0;
  int edges = 0;
  for (int v = 0; v + kCell_px <= light.height; v += kCell_px) {
    for (int u = 0; u + kCell_px <= light.width; u += kCell_px) {
      ++cells;
      if (holds_edge(light, u, v)) ++edges;
    }
  }
  return static_cast<double>(edges) / cells;
}

}  // namespace

Quaterniond looking(double heading_rad, double pitch_rad, double roll_rad) {
  static const Quaterniond kLevel((Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());  // along world x
  const Eigen::AngleAxisd heading(heading_rad, Vector3d::UnitZ());
  const Eigen::AngleAxisd pitch(pitch_rad, Vector3d::UnitX());
  const Eigen::AngleAxisd roll(roll_rad, Vector3d::UnitZ());
  return (heading * kLevel * pitch * roll).normalized();
}

double HeadingTexture::at(double heading_rad) const {
  const double place = heading_rad / kStep_rad;
  const double below = std::floor(place);
  const auto index = [](double whole) {
    const auto count = static_cast<std::int64_t>(kHeadings);
    return static_cast<std::size_t>(((static_cast<std::int64_t>(whole) % count) + count) % count);
  };
  const double fraction = place - below;
  return (1 - fraction) * share[index(below)] + fraction * share[index(below + 1)];
}

double HeadingTexture::best_turn_rad(const synthetic_imu::PoseSpline& camera) const {
  std::vector<double> headings;
  for (const Quaterniond& rotation : camera.rotation_world_body) {
    const Vector3d forward = rotation * Vector3d::UnitZ();
    headings.push_back(std::atan2(forward.y(), forward.x()));
  }
  const std::size_t tenth = std::max<std::size_t>(1, headings.size() / 10);
  double best = -1;
  double best_rad = 0;
  for (std::size_t i = 0; i < kHeadings; ++i) {
    const double turn_rad = static_cast<double>(i) * kStep_rad;
    std::vector<double> seen;
    for (const double heading_rad : headings) seen.push_back(at(heading_rad + turn_rad));
    std::ranges::sort(seen);
    double least = 0;
    for (std::size_t j = 0; j < tenth; ++j) least += seen[j];
    if (least > best + 1e-9) {
      best = least;
      best_rad = turn_rad;
    }
  }
  return best_rad;
}

HeadingTexture look_around(const render::Renderer& renderer, const Eigen::AlignedBox3d& box,
                           const Workers& workers) {
  constexpr double kPitch_rad = radians(-8.0);
  HeadingTexture texture;
  Image<Eigen::Vector3f> light;
  for (std::size_t i = 0; i < HeadingTexture::kHeadings; ++i) {
    const render::RowPoses poses{
        {{looking(static_cast<double>(i) * kStep_rad, kPitch_rad, 0), box.center()}}};
    renderer.render_light(kViewer, poses, Vector2d::Zero(), workers, light);
    texture.share[i] = share_of_edges(light);
  }
  return texture;
}

}  // namespace fusebench::simulator::motion
