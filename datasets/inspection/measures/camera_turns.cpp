#include "datasets/inspection/measures/camera_turns.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <optional>
#include <utility>

#include "datasets/inspection/measures/order_statistics.hpp"

namespace fusebench::inspection::measures {

namespace {

constexpr std::int64_t kMinTurn_ns = 30'000'000;
constexpr std::int64_t kMaxTurn_ns = 150'000'000;
constexpr std::int64_t kMargin_ns = 2'000'000'000;
constexpr std::size_t kRuns = 6;
constexpr int kCorners = 300;
constexpr int kMinInliers = 40;

cv::Mat view_of(const GreyImage& image) {
  // OpenCV has no read-only view; nothing writes through this one.
  return {image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data.data())};
}

/// Corners at the edges of things follow the thing in front, and their depth may be that of the one behind.
bool lies_on_surface(const DepthImage& depth_m, int x, int y) {
  constexpr int kReach = 3;
  if (!depth_m.contains(x - kReach, y - kReach) || !depth_m.contains(x + kReach, y + kReach)) return false;
  const float z_m = depth_m(x, y);
  if (z_m <= 0) return false;
  for (int dy = -kReach; dy <= kReach; dy += kReach) {
    for (int dx = -kReach; dx <= kReach; dx += kReach) {
      const float neighbour_m = depth_m(x + dx, y + dy);
      if (neighbour_m <= 0 || std::abs(neighbour_m - z_m) > 0.05F * z_m) return false;
    }
  }
  return true;
}

struct Tracks {
  std::vector<cv::Point3f> points_from;  ///< metres
  std::vector<cv::Point2f> pixels_to;
};

/// Corners of an image and where they are in the other one, if they are found.
struct FollowedCorners {
  std::vector<cv::Point2f> corners, moved;
  std::vector<std::uint8_t> found;
};

FollowedCorners follow_corners(const GreyImage& from, const GreyImage& to) {
  FollowedCorners followed;
  cv::goodFeaturesToTrack(view_of(from), followed.corners, kCorners, 0.01, 8);
  if (followed.corners.empty()) return followed;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(view_of(from), view_of(to), followed.corners, followed.moved, followed.found,
                           error, cv::Size(21, 21), 4);
  return followed;
}

Tracks track_corners(const RgbdFrame& from, const RgbdFrame& to, const PinholeCamera& camera) {
  const auto [corners, moved, found] = follow_corners(from.grey, to.grey);
  Tracks tracks;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int x = cvRound(corners[i].x), y = cvRound(corners[i].y);
    if (found[i] == 0 || !lies_on_surface(from.depth_m, x, y)) continue;
    const Vector3d point =
        camera.back_project(static_cast<double>(corners[i].x), static_cast<double>(corners[i].y),
                            static_cast<double>(from.depth_m(x, y)));
    tracks.points_from.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()),
                                    static_cast<float>(point.z()));
    tracks.pixels_to.push_back(moved[i]);
  }
  return tracks;
}

std::optional<Vector3d> turn_between(const RgbdFrame& from, const RgbdFrame& to,
                                     const PinholeCamera& camera) {
  const Tracks tracks = track_corners(from, to, camera);
  if (tracks.points_from.size() < static_cast<std::size_t>(kMinInliers)) return std::nullopt;
  const cv::Matx33d intrinsics(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  cv::Mat rotation, translation;
  std::vector<int> inliers;
  const bool solved =
      cv::solvePnPRansac(tracks.points_from, tracks.pixels_to, intrinsics, cv::noArray(), rotation,
                         translation, false, 100, 2.0F, 0.99, inliers, cv::SOLVEPNP_EPNP);
  if (!solved || inliers.size() < static_cast<std::size_t>(kMinInliers)) return std::nullopt;
  std::vector<cv::Point3f> points;
  std::vector<cv::Point2f> pixels;
  for (const int i : inliers) {
    points.push_back(tracks.points_from[static_cast<std::size_t>(i)]);
    pixels.push_back(tracks.pixels_to[static_cast<std::size_t>(i)]);
  }
  cv::solvePnPRefineLM(points, pixels, intrinsics, cv::noArray(), rotation, translation);
  // OpenCV's rotation maps into the later frame: the inverse of R_begin_end.
  return Vector3d(-rotation.at<double>(0), -rotation.at<double>(1), -rotation.at<double>(2));
}

/// First frames of the runs in which the gyroscope turns most.
std::vector<std::size_t> busiest_runs(const recording::Recording& recording, std::size_t run_length) {
  std::vector<double> activity(recording.frames.size(), 0);
  for (std::size_t k = 0; k + 1 < recording.frames.size(); ++k) {
    const auto begin =
        std::ranges::lower_bound(recording.imu, recording.frames[k].capture_ns, {}, &ImuSample::timestamp_ns);
    for (auto s = begin; s != recording.imu.end() && s->timestamp_ns < recording.frames[k + 1].capture_ns;
         ++s)
      activity[k] += s->angular_velocity_radps.squaredNorm();
  }
  const std::size_t frames = recording.frames.size();
  const std::size_t runs = std::clamp<std::size_t>(frames / std::max<std::size_t>(1, run_length), 1, kRuns);
  std::vector<std::size_t> result;
  for (std::size_t r = 0; r < runs; ++r) {
    const std::size_t begin = r * frames / runs;
    const std::size_t end = (r + 1) * frames / runs;
    std::size_t best = begin;
    double best_sum = -1;
    for (std::size_t first = begin; first + 1 < end; first += 5) {
      double sum = 0;
      for (std::size_t k = first; k < std::min(first + run_length, end); ++k) sum += activity[k];
      if (sum > best_sum) {
        best_sum = sum;
        best = first;
      }
    }
    result.push_back(best);
  }
  return result;
}

/// Turns between neighbours from the first to the last frame. An image that repeats the one before shows
/// nothing of its own instant: it is left out.
std::vector<CameraTurn> turns_of_run(const recording::Recording& recording, std::size_t first,
                                     std::size_t last) {
  std::vector<CameraTurn> turns;
  std::optional<RgbdFrame> before;
  std::int64_t begin_ns = 0;
  for (std::size_t k = first; k <= last; ++k) {
    auto loaded = recording.load_frame(k);
    if (!loaded) {
      before.reset();
      continue;
    }
    if (before && loaded->grey.data == before->grey.data) continue;
    const std::int64_t end_ns = recording.frames[k].capture_ns;
    if (before && end_ns - begin_ns <= kMaxTurn_ns) {
      const auto turn = turn_between(*before, *loaded, recording.rig.camera);
      if (turn) turns.push_back({begin_ns, end_ns, *turn});
    }
    before = std::move(*loaded);
    begin_ns = end_ns;
  }
  return turns;
}

}  // namespace

std::optional<double> image_motion_px(const GreyImage& from, const GreyImage& to) {
  const auto [corners, moved, found] = follow_corners(from, to);
  std::vector<double> motion_px;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (found[i] != 0)
      motion_px.push_back(
          static_cast<double>(std::hypot(moved[i].x - corners[i].x, moved[i].y - corners[i].y)));
  }
  if (motion_px.size() < static_cast<std::size_t>(kMinInliers)) return std::nullopt;
  return median(std::move(motion_px));
}

CameraTurns turns_from_truth(const recording::Recording& recording) {
  CameraTurns result{"ground truth", {}};
  const std::int64_t begin_ns = recording.frames.front().capture_ns - kMargin_ns;
  const std::int64_t end_ns = recording.frames.back().capture_ns + kMargin_ns;
  const StampedPose* last = nullptr;
  for (const StampedPose& pose : recording.ground_truth) {
    if (pose.timestamp_ns < begin_ns || pose.timestamp_ns > end_ns) continue;
    const std::int64_t interval_ns = last == nullptr ? 0 : pose.timestamp_ns - last->timestamp_ns;
    if (last != nullptr && interval_ns < kMinTurn_ns) continue;
    if (last != nullptr && interval_ns <= kMaxTurn_ns) {
      const Quaterniond turn = last->T_world_camera.rotation.conjugate() * pose.T_world_camera.rotation;
      result.turns.push_back({last->timestamp_ns, pose.timestamp_ns, so3_log(turn.normalized())});
    }
    last = &pose;
  }
  return result;
}

CameraTurns turns_from_images(const recording::Recording& recording, const Workers& workers,
                              std::size_t count) {
  CameraTurns result{"images", {}};
  if (recording.imu.empty() || recording.frames.size() < 2) return result;
  const std::size_t run_length = std::max<std::size_t>(2, count / kRuns);
  const std::vector<std::size_t> firsts = busiest_runs(recording, run_length);
  const auto runs =
      workers.map_chunks<std::vector<CameraTurn>>(firsts.size(), 1, [&](std::size_t r, std::size_t) {
        return turns_of_run(recording, firsts[r],
                            std::min(firsts[r] + run_length, recording.frames.size() - 1));
      });
  for (const auto& run : runs) result.turns.insert(result.turns.end(), run.begin(), run.end());
  return result;
}

}  // namespace fusebench::inspection::measures
