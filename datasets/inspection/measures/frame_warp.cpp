#include "datasets/inspection/measures/frame_warp.hpp"

#include <cmath>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection::measures {

namespace {

constexpr int kPointsAcross = 48;  // about 1700 points of a whole image
constexpr double kSmooth = 0.03;

}  // namespace

bool is_smooth(const DepthImage& depth_m, int x, int y) {
  const float z_m = depth_m(x, y);
  if (z_m <= 0) return false;
  for (const auto& [dx, dy] : {std::pair(-2, 0), std::pair(2, 0), std::pair(0, -2), std::pair(0, 2)}) {
    const float neighbour_m = depth_m(x + dx, y + dy);
    if (neighbour_m <= 0 || std::abs(neighbour_m - z_m) > kSmooth * static_cast<double>(z_m)) return false;
  }
  return true;
}

namespace {

/// A camera pose in the ground truth's world under a reading.
std::optional<SE3> pose_at(const Trajectory& truth, std::int64_t time_ns, std::int64_t gap_ns,
                           const Reading& reading) {
  const auto pose = trajectory::interpolate_pose(truth, time_ns + reading.truth_shift_ns, gap_ns);
  if (!pose || !reading.pose) return pose;
  return reading.pose(*pose);
}

std::optional<Vector2d> pixel_of(const PinholeCamera& camera, const Vector3d& point) {
  if (point.z() < 1e-3) return std::nullopt;
  const Vector2d pixel = camera.project(point);
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= camera.width_px - 1 &&
        pixel.y() <= camera.height_px - 1))
    return std::nullopt;
  return pixel;
}

PinholeCamera camera_of(const PinholeCamera& given, const Reading& reading) {
  PinholeCamera camera = given;
  camera.fx_px *= reading.focal_scale * reading.image_scale;
  camera.fy_px *= reading.focal_scale * reading.image_scale;
  // The image begins at (-0.5, -0.5).
  camera.cx_px += (reading.image_scale - 1) * (given.cx_px + 0.5);
  camera.cy_px += (reading.image_scale - 1) * (given.cy_px + 0.5);
  return camera;
}

/// z of a measured depth.
double z_of(double depth_m, double x_px, double y_px, const PinholeCamera& camera, const Reading& reading) {
  const double scaled_m = reading.depth_scale * depth_m;
  if (!reading.depth_along_ray) return scaled_m;
  const double x = (x_px - camera.cx_px) / camera.fx_px, y = (y_px - camera.cy_px) / camera.fy_px;
  return scaled_m / std::sqrt(1 + x * x + y * y);
}

/// Grey level of the scene at a pixel of the camera.
double grey_at(const GreyImage& grey, const Vector2d& pixel, const Reading& reading) {
  const double x = reading.color_mirrored_x ? grey.width - 1 - pixel.x() : pixel.x();
  const double y = reading.color_mirrored_y ? grey.height - 1 - pixel.y() : pixel.y();
  return sample_bilinear(grey, x, y).value;
}

struct PairPoses {
  SE3 T_depth2_depth1;
  SE3 T_color1_depth1;
  SE3 T_color2_depth1;
};

std::optional<PairPoses> poses_of(const WarpPair& pair, const Trajectory& truth, std::int64_t gap_ns,
                                  const Reading& reading) {
  const auto depth1 = pose_at(truth, pair.from_depth_ns + reading.depth_shift_ns, gap_ns, reading);
  const auto color1 = pose_at(truth, pair.from_color_ns, gap_ns, reading);
  const auto depth2 = pose_at(truth, pair.to_depth_ns + reading.depth_shift_ns, gap_ns, reading);
  const auto color2 = pose_at(truth, pair.to_color_ns, gap_ns, reading);
  if (!depth1 || !color1 || !depth2 || !color2) return std::nullopt;
  return PairPoses{depth2->inverse() * *depth1, color1->inverse() * *depth1, color2->inverse() * *depth1};
}

}  // namespace

WarpPair make_warp_pair(std::size_t from, std::size_t to, const RgbdFrame& from_frame, RgbdFrame&& to_frame) {
  WarpPair pair;
  pair.from = from;
  pair.to = to;
  pair.from_color_ns = from_frame.capture_ns();
  pair.from_depth_ns = from_frame.capture_ns() + from_frame.depth_offset_ns;
  pair.to_color_ns = to_frame.capture_ns();
  pair.to_depth_ns = to_frame.capture_ns() + to_frame.depth_offset_ns;
  const DepthImage& depth_m = from_frame.depth_m;
  const int step = std::max(2, depth_m.width / kPointsAcross);
  for (int y = step; y + step < depth_m.height; y += step) {
    for (int x = step; x + step < depth_m.width; x += step) {
      if (is_smooth(depth_m, x, y))
        pair.points.push_back(
            {static_cast<double>(x), static_cast<double>(y), static_cast<double>(depth_m(x, y))});
    }
  }
  pair.from_grey = from_frame.grey;
  pair.to_grey = std::move(to_frame.grey);
  pair.to_depth_m = std::move(to_frame.depth_m);
  return pair;
}

std::optional<WarpResidual> warp(const WarpPair& pair, const PinholeCamera& given, const Trajectory& truth,
                                 std::int64_t truth_gap_ns, const Reading& reading) {
  const auto poses = poses_of(pair, truth, truth_gap_ns, reading);
  if (!poses) return std::nullopt;
  const PinholeCamera camera = camera_of(given, reading);
  std::vector<double> depth_m, depth_share, intensity;
  for (const MeasuredPoint& point : pair.points) {
    const double z1_m = z_of(point.depth_m, point.x_px, point.y_px, camera, reading);
    const Vector3d point1 = camera.back_project(point.x_px, point.y_px, z1_m);
    const Vector3d point2 = poses->T_depth2_depth1 * point1;
    const auto pixel = pixel_of(camera, point2);
    if (pixel) {
      const auto x = static_cast<int>(std::lround(pixel->x()));
      const auto y = static_cast<int>(std::lround(pixel->y()));
      const auto measured_m = static_cast<double>(pair.to_depth_m(x, y));
      if (measured_m > 0) {
        const double difference_m = std::abs(z_of(measured_m, x, y, camera, reading) - point2.z());
        depth_m.push_back(difference_m);
        depth_share.push_back(difference_m / point2.z());
      }
    }
    const auto color1 = pixel_of(camera, poses->T_color1_depth1 * point1);
    const auto color2 = pixel_of(camera, poses->T_color2_depth1 * point1);
    if (color1 && color2) {
      intensity.push_back(grey_at(pair.to_grey, *color2, reading) -
                          grey_at(pair.from_grey, *color1, reading));
    }
  }
  WarpResidual result;
  result.points = std::min(depth_m.size(), intensity.size());
  result.overlap =
      pair.points.empty() ? 0 : static_cast<double>(result.points) / static_cast<double>(pair.points.size());
  const double brightness = median(intensity);  // exposure control changes it between frames
  for (double& difference : intensity) difference = std::abs(difference - brightness);
  result.depth_m = median(std::move(depth_m));
  result.depth_share = median(std::move(depth_share));
  result.intensity_grey = median(std::move(intensity));
  return result;
}

}  // namespace fusebench::inspection::measures
