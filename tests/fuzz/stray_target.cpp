// The tables of Stray Scanner.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/recording/formats/stray/stray_tables.hpp"
#include "datasets/recording/sensor_columns.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace formats::stray;

void stray(std::string_view bytes) {
  static const MemoryFile file("odometry.csv");
  file.write(bytes);
  std::vector<std::string> warnings;
  const auto frames = read_stray_odometry(file.path(), warnings);
  if (!frames) check_error(frames.error(), file.path());
  for (std::size_t i = 0; frames && i < frames->size(); ++i) {
    const StrayFrame& frame = (*frames)[i];
    check(std::abs(frame.T_world_camera.rotation.norm() - 1) < 1e-9, "a rotation has unit length");
    check(i == 0 ||
              ((*frames)[i - 1].timestamp_ns < frame.timestamp_ns && (*frames)[i - 1].index < frame.index),
          "times and numbers rise");
  }
  recording::Recording recording;
  const auto read = read_stray_imu(file.path(), recording);
  if (!read) check_error(read.error(), file.path());
  for (std::size_t i = 0; i < recording.imu.size(); ++i) {
    check(
        recording.imu[i].specific_force_mps2.cwiseAbs().maxCoeff() <= 10 * recording::kMaxSpecificForce_mps2,
        "a force is one that was measured");
    check(i == 0 || recording.imu[i - 1].timestamp_ns < recording.imu[i].timestamp_ns,
          "time strictly increases");
  }
}

}  // namespace fusebench::fuzz
