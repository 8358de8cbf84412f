// Trajectories as TUM text.
#include <algorithm>
#include <cmath>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace trajectory;

namespace {

void check_poses(const Trajectory& poses) {
  check(!poses.empty(), "a trajectory has poses");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    check(i == 0 || poses[i].timestamp_ns > poses[i - 1].timestamp_ns, "time strictly increases");
    check(poses[i].T_world_camera.translation.allFinite(), "positions are finite");
    check(std::abs(poses[i].T_world_camera.rotation.norm() - 1) < 1e-12, "quaternions have unit length");
  }
  check(seconds_between(poses.front().timestamp_ns, poses.back().timestamp_ns) >= 0,
        "a span is not negative");
}

void check_round_trip(const MemoryFile& file, const Trajectory& poses) {
  file.write(tum_text(poses));
  std::vector<std::string> warnings;
  const auto again = read_tum_trajectory(file.path(), warnings);
  check(again && warnings.empty() && again->size() == poses.size(), "what is written reads back");
  check(std::ranges::equal(*again, poses,
                           [](const StampedPose& a, const StampedPose& b) {
                             return a.timestamp_ns == b.timestamp_ns &&
                                    a.T_world_camera.translation == b.T_world_camera.translation;
                           }),
        "times and positions read back as they were");
}

}  // namespace

void trajectory(std::string_view bytes) {
  static const MemoryFile file("trajectory.txt");
  for (const auto duplicates :
       {Duplicates::error, Duplicates::last_in_order, Duplicates::first, Duplicates::last}) {
    file.write(bytes);
    std::vector<std::string> warnings;
    const auto poses = read_tum_trajectory(file.path(), warnings, duplicates);
    if (!poses) {
      check_error(poses.error(), file.path());
      continue;
    }
    check_poses(*poses);
    static_cast<void>(interpolate_pose(*poses, 0, 100'000'000));
    check_round_trip(file, *poses);
  }
}

}  // namespace fusebench::fuzz
