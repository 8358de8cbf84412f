// groundtruth.txt and imu.csv, which may lie beside the images of any format.
#include "datasets/recording/reading/side_files.hpp"

#include <cmath>

#include "datasets/recording/sensor_columns.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace recording;
using namespace reading;

namespace {

Recording recording_of_two_frames() {
  Recording recording;
  recording.frames.resize(2);
  recording.frames[0].timestamp_ns = 1'000'000'000;
  recording.frames[1].timestamp_ns = 2'000'000'000;
  return recording;
}

void check_imu(const MemoryFile& file) {
  Recording recording = recording_of_two_frames();
  if (const auto read = read_imu_beside(file.folder(), recording); !read) {
    check(recording.imu_source == ImuSource::none, "a refused file leaves the recording without IMU");
    return check_error(read.error(), file.path());
  }
  check(recording.imu_source == ImuSource::recorded && !recording.imu.empty(), "an IMU has samples");
  for (std::size_t i = 0; i < recording.imu.size(); ++i) {
    const ImuSample& sample = recording.imu[i];
    check(i == 0 || sample.timestamp_ns > recording.imu[i - 1].timestamp_ns, "time strictly increases");
    check(sample.angular_velocity_radps.cwiseAbs().maxCoeff() <= kMaxAngularVelocity_radps &&
              sample.specific_force_mps2.cwiseAbs().maxCoeff() <= kMaxSpecificForce_mps2,
          "samples are what a sensor can measure");
  }
}

void check_truth(const MemoryFile& file) {
  Recording recording = recording_of_two_frames();
  if (const auto read = read_ground_truth_beside(file.folder(), recording); !read) {
    return check_error(read.error(), file.path());
  }
  check(!recording.ground_truth.empty(), "a ground truth has poses");
  for (const StampedPose& pose : recording.ground_truth) {
    check(pose.T_world_camera.translation.cwiseAbs().maxCoeff() <= kMaxPosition_m, "poses are on Earth");
  }
  check(recording.ground_truth.front().timestamp_ns <= 2'000'000'000 &&
            recording.ground_truth.back().timestamp_ns >= 1'000'000'000,
        "a ground truth overlaps the images");
}

}  // namespace

void side_files(std::string_view bytes) {
  static const MemoryFile imu("imu.csv");
  imu.write(bytes);
  check_imu(imu);
  static const MemoryFile truth("groundtruth.txt");
  truth.write(bytes);
  check_truth(truth);
}

}  // namespace fusebench::fuzz
