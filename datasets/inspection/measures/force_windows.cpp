#include "datasets/inspection/measures/force_windows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/trajectory/trajectory.hpp"

namespace fusebench::inspection::measures {

namespace {

constexpr std::int64_t kWindow_ns = 400'000'000;
constexpr std::int64_t kHalfStep_ns = 50'000'000;
constexpr std::int64_t kBlock_ns = 3'000'000'000;
constexpr std::int64_t kPause_ns = 50'000'000;
constexpr int kMinSamples = 10;
constexpr std::size_t kMinWindows = 6;

/// Sums of a window in the making.
class WindowSums {
 public:
  void add(const Matrix3d& rotation, const Vector3d& force_mps2) {
    window_.rotation += rotation;
    for (std::size_t j = 0; j < 3; ++j)
      window_.moments[j] += force_mps2[static_cast<Eigen::Index>(j)] * rotation;
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] ForceWindow mean(std::size_t block) const {
    ForceWindow window = window_;
    window.block = block;
    window.rotation /= count_;
    for (Matrix3d& moment : window.moments) moment /= count_;
    return window;
  }

 private:
  ForceWindow window_;
  int count_ = 0;
};

struct ImuPose {
  Matrix3d rotation;
  Vector3d position_m;
};

/// At a stamp of the IMU.
std::optional<ImuPose> imu_pose_at(const TruePath& path, std::int64_t imu_ns) {
  const std::int64_t offset_ns = std::llround(1e9 * path.time_offset_s);
  const auto pose = trajectory::interpolate_pose(path.ground_truth, imu_ns - offset_ns, path.gap_ns);
  if (!pose) return std::nullopt;
  return ImuPose{pose->rotation_matrix() * path.rotation_camera_imu, *pose * path.imu_in_camera_m};
}

/// Central difference over 0.1 s: shorter ones show the jitter of the ground truth.
std::optional<Vector3d> imu_velocity_at(const TruePath& path, std::int64_t imu_ns) {
  const auto before = imu_pose_at(path, imu_ns - kHalfStep_ns),
             after = imu_pose_at(path, imu_ns + kHalfStep_ns);
  if (!before || !after) return std::nullopt;
  return (after->position_m - before->position_m) / seconds_between(-kHalfStep_ns, kHalfStep_ns);
}

}  // namespace

Vector3d ForceWindow::force(const Matrix3d& axes) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t j = 0; j < 3; ++j) sum += moments[j] * axes.col(static_cast<Eigen::Index>(j));
  return sum;
}

std::vector<ForceWindow> windows_by_truth(std::span<const ImuSample> samples, const TruePath& path,
                                          double unit) {
  std::vector<ForceWindow> windows;
  std::size_t i = 0;
  while (i < samples.size()) {
    const std::int64_t begin_ns = samples[i].timestamp_ns;
    WindowSums sums;
    bool is_whole = true;
    for (; i < samples.size() && samples[i].timestamp_ns < begin_ns + kWindow_ns; ++i) {
      const auto pose = imu_pose_at(path, samples[i].timestamp_ns);
      is_whole = is_whole && pose;
      if (pose) sums.add(pose->rotation, unit * samples[i].specific_force_mps2);
    }
    const auto begin_velocity = imu_velocity_at(path, begin_ns);
    const auto end_velocity = imu_velocity_at(path, begin_ns + kWindow_ns);
    if (!is_whole || sums.count() < kMinSamples || !begin_velocity || !end_velocity) continue;
    windows.push_back(sums.mean(0));
    windows.back().acceleration_mps2 = (*end_velocity - *begin_velocity) / seconds_between(0, kWindow_ns);
  }
  return windows;
}

std::vector<ForceWindow> windows_by_gyroscope(std::span<const ImuSample> samples,
                                              const Vector3d& gyroscope_bias_radps,
                                              const Matrix3d& gyroscope_axes, double unit) {
  std::vector<ForceWindow> windows;
  std::size_t block = 0;
  std::size_t i = 0;
  while (i < samples.size()) {
    const std::int64_t block_ns = samples[i].timestamp_ns;
    Quaterniond orientation = Quaterniond::Identity();  // R_begin_imu
    std::int64_t window_ns = block_ns;
    WindowSums sums;
    for (std::size_t first = i; i < samples.size() && samples[i].timestamp_ns < block_ns + kBlock_ns; ++i) {
      if (i > first) {
        const std::int64_t dt_ns = samples[i].timestamp_ns - samples[i - 1].timestamp_ns;
        if (dt_ns > kPause_ns) break;
        const Vector3d rate_radps =
            0.5 * (samples[i - 1].angular_velocity_radps + samples[i].angular_velocity_radps) -
            gyroscope_bias_radps;
        orientation =
            (orientation * so3_exp(gyroscope_axes.transpose() * rate_radps * seconds_between(0, dt_ns)))
                .normalized();
      }
      if (samples[i].timestamp_ns >= window_ns + kWindow_ns) {
        if (sums.count() >= kMinSamples) windows.push_back(sums.mean(block));
        sums = {};
        window_ns = samples[i].timestamp_ns;
      }
      sums.add(orientation.toRotationMatrix(), unit * samples[i].specific_force_mps2);
    }
    ++block;
  }
  return windows;
}

namespace {

/// Of the windows of each block, what differs from their mean: gravity is eliminated.
struct CentredWindows {
  std::vector<ForceWindow> windows;
  std::size_t blocks = 0;
};

CentredWindows centred(std::span<const ForceWindow> windows) {
  CentredWindows result;
  for (std::size_t first = 0; first < windows.size();) {
    std::size_t end = first;
    ForceWindow mean;
    for (; end < windows.size() && windows[end].block == windows[first].block; ++end) {
      mean.rotation += windows[end].rotation;
      mean.acceleration_mps2 += windows[end].acceleration_mps2;
      for (std::size_t j = 0; j < 3; ++j) mean.moments[j] += windows[end].moments[j];
    }
    const auto count = static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i) {
      ForceWindow window = windows[i];
      window.rotation -= mean.rotation / count;
      window.acceleration_mps2 -= mean.acceleration_mps2 / count;
      for (std::size_t j = 0; j < 3; ++j) window.moments[j] -= mean.moments[j] / count;
      result.windows.push_back(window);
    }
    ++result.blocks;
    first = end;
  }
  return result;
}

/// Sum of squared residuals at the best bias.
double cost_of_axes(const std::vector<ForceWindow>& windows, const Matrix3d& axes) {
  // Of a residual of 0.3 m/s^2, as accelerations of a hand are over a window, to a bias of 0.5 m/s^2.
  constexpr double kBiasWeight = 0.36;
  Matrix3d normal = kBiasWeight * Matrix3d::Identity();
  Vector3d right = Vector3d::Zero();
  double squares = 0;
  for (const ForceWindow& window : windows) {
    const Vector3d difference = window.force(axes) - window.acceleration_mps2;
    normal += window.rotation.transpose() * window.rotation;
    right += window.rotation.transpose() * difference;
    squares += difference.squaredNorm();
  }
  return std::max(0.0, squares - right.dot(normal.inverse() * right));
}

}  // namespace

std::optional<AxesChoice> choose_accelerometer_axes(std::span<const ForceWindow> windows, std::size_t given,
                                                    bool by_truth) {
  const CentredWindows rest = centred(windows);
  const double freedom = 3 * (static_cast<double>(windows.size()) - static_cast<double>(rest.blocks)) - 3;
  if (windows.size() < kMinWindows || freedom < 1) return std::nullopt;
  const auto all = signed_permutations();
  std::vector<double> costs;
  for (const Matrix3d& axes : by_truth ? all : all.first(kProperPermutations))
    costs.push_back(cost_of_axes(rest.windows, axes.transpose()));
  return choose_axes(costs, given, freedom);
}

}  // namespace fusebench::inspection::measures
