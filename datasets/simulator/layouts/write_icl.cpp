#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "datasets/simulator/layouts/write_lists.hpp"

namespace fusebench::simulator::layouts {

namespace {

constexpr double kStartOffset_m = -2.25;  // of the published trajectories, along the axis of the first camera

SE3 pose_at(const Trajectory& truth, std::int64_t time_ns) {
  const auto found = std::ranges::lower_bound(truth, time_ns, {}, &StampedPose::timestamp_ns);
  check(found != truth.end() && found->timestamp_ns == time_ns, "the ground truth has every frame");
  return found->T_world_camera;
}

}  // namespace

std::string icl_color_name(std::size_t frame, std::int64_t) { return fmt::format("rgb/{}.png", frame); }

std::string icl_depth_name(std::size_t frame, std::int64_t) { return fmt::format("depth/{}.png", frame); }

SE3 icl_T_file_scene(const SimulatedData& data) {
  const SE3 start{Quaterniond::Identity(), {0, 0, kStartOffset_m}};
  return start * pose_at(data.truth, data.frame_ns[1]).inverse();
}

Result<void> write_icl_lists(const std::filesystem::path& folder, const SimulatedData& data) {
  const SE3 T_file_scene = icl_T_file_scene(data);
  std::string pairs;
  std::string truth;
  for (std::size_t k = 0; k < data.frame_ns.size(); ++k) {
    if (data.has_frame(k)) {
      fmt::format_to(std::back_inserter(pairs), "{} {} {} {}\n", k, icl_depth_name(k, 0), k,
                     icl_color_name(k, 0));
    }
    if (k == 0) continue;  // the published trajectories begin with frame 1
    const SE3 T = formats::icl::icl_reflect(T_file_scene * pose_at(data.truth, data.frame_ns[k]));
    const Vector3d& t = T.translation;
    const Eigen::Vector4d q = (T.rotation.w() < 0 ? -1.0 : 1.0) * T.rotation.coeffs();
    fmt::format_to(std::back_inserter(truth), "{} {} {} {} {} {} {} {}\n", k, t.x(), t.y(), t.z(), q[0], q[1],
                   q[2], q[3]);
  }
  if (auto written = write_text(folder / "associations.txt", pairs); !written) return written;
  if (auto written = write_text(folder / "livingRoom0.gt.freiburg", truth); !written) return written;
  return write_imu_csv(folder / "imu.csv", data.imu.samples);
}

}  // namespace fusebench::simulator::layouts
