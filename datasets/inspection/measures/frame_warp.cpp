#include "datasets/inspection/measures/frame_warp.hpp"

#include <cmath>
#include <utility>

#include "core/trajectory/trajectory.hpp"
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

/// A camera pose in the truth's world under a reading.
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

struct PairPoses {
  SE3 T_depth2_depth1;
  SE3 T_color1_depth1;
  SE3 T_color2_depth1;
};

std::optional<PairPoses> poses_of(const WarpPair& pair, const Trajectory& truth, std::int64_t gap_ns,
                                  const Reading& reading) {
  const auto depth1 = pose_at(truth, pair.from_depth_ns, gap_ns, reading);
  const auto color1 = pose_at(truth, pair.from_color_ns, gap_ns, reading);
  const auto depth2 = pose_at(truth, pair.to_depth_ns, gap_ns, reading);
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
  PinholeCamera camera = given;
  camera.fx_px *= reading.focal_scale;
  camera.fy_px *= reading.focal_scale;
  std::vector<double> depth_m, depth_share, intensity;
  for (const MeasuredPoint& point : pair.points) {
    const Vector3d point1 = camera.back_project(point.x_px, point.y_px, reading.depth_scale * point.depth_m);
    const Vector3d point2 = poses->T_depth2_depth1 * point1;
    const auto pixel = pixel_of(camera, point2);
    if (pixel) {
      const float z_m = pair.to_depth_m(static_cast<int>(std::lround(pixel->x())),
                                        static_cast<int>(std::lround(pixel->y())));
      if (z_m > 0) {
        const double difference_m = std::abs(reading.depth_scale * static_cast<double>(z_m) - point2.z());
        depth_m.push_back(difference_m);
        depth_share.push_back(difference_m / point2.z());
      }
    }
    const auto color1 = pixel_of(camera, poses->T_color1_depth1 * point1);
    const auto color2 = pixel_of(camera, poses->T_color2_depth1 * point1);
    if (color1 && color2) {
      intensity.push_back(sample_bilinear(pair.to_grey, color2->x(), color2->y()).value -
                          sample_bilinear(pair.from_grey, color1->x(), color1->y()).value);
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
