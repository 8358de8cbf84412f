#include "core/base/trajectory/trajectory_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "core/base/trajectory/pose_head.hpp"
#include "core/base/trajectory/pose_table.hpp"

namespace fusebench::trajectory {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

std::string stamp_text(std::int64_t timestamp_ns) {
  const bool negative = timestamp_ns < 0;
  const std::int64_t magnitude = negative ? -timestamp_ns : timestamp_ns;
  return fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / kNanosecondsPerSecond,
                     magnitude % kNanosecondsPerSecond);
}

std::string tum_text(const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) {
    const Vector3d& t = pose.T_world_camera.translation;
    // q and -q are one rotation; one sign makes files comparable.
    const double sign = pose.T_world_camera.rotation.w() < 0 ? -1.0 : 1.0;
    const Eigen::Vector4d q = sign * pose.T_world_camera.rotation.coeffs();
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", stamp_text(pose.timestamp_ns),
                   t.x(), t.y(), t.z(), q[0], q[1], q[2], q[3]);
  }
  return text;
}

Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                       Duplicates duplicates) {
  const auto head = read_pose_head(file, warnings);
  if (!head) return tl::unexpected(head.error());
  PoseLayout layout = layout_of(*head, {}, file, warnings);
  layout.unit = stamp_unit_of(*head, layout.columns, {}, file, warnings);
  auto rows = read_pose_rows(file, layout, order_for(duplicates), warnings);
  if (!rows) return tl::unexpected(rows.error());
  return ordered(std::move(*rows), duplicates, file, warnings);
}

}  // namespace fusebench::trajectory
