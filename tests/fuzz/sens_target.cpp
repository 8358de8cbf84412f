// Files of BundleFusion and ScanNet: frames, and the poses alone.
#include "core/base/error.hpp"
#include "datasets/recording/image_logs/file_part.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace image_logs;

namespace {

/// Reads what can be read; poses have to be those of the reader that leaves images out.
void check_frames(const MemoryFile& file) {
  auto with_images = SensReader::open(file.path());
  auto poses_alone = SensReader::open(file.path());
  check(with_images.has_value() == poses_alone.has_value(), "a file opens each time or never");
  if (!with_images) {
    check(with_images.error().code == ErrorCode::data_corrupt, "what is read can only be corrupt");
    return;
  }
  std::uint64_t read = 0;
  while (true) {
    const auto frame = with_images->next();
    if (!frame) {
      check(frame.error().code == ErrorCode::data_corrupt, "damage of a frame is an error of its own");
      return;
    }
    const auto pose = poses_alone->next_parts();
    check(pose.has_value(), "what can be read with images can be read without");
    check(frame->has_value() == pose->has_value(), "both end together");
    if (!*frame) break;
    ++read;
    check((*frame)->T_world_camera.has_value() == (*pose)->T_world_camera.has_value(),
          "a frame has a pose or has none");
    check((*frame)->color_timestamp_us == (*pose)->color_timestamp, "stamps are the same");
    check((*frame)->depth.width == with_images->header().depth.width_px, "depth has the size of the header");
  }
  check(read == with_images->header().frames, "a file has as many frames as it says");
}

/// The places of images are those of the bytes that the reader takes.
void check_parts(const MemoryFile& file) {
  auto parts_alone = SensReader::open(file.path());
  auto with_images = SensReader::open(file.path());
  if (!parts_alone) return;
  while (true) {
    const auto parts = parts_alone->next_parts();
    if (!parts) return;
    if (!*parts) break;
    const auto color = bytes_of_file(file.path(), (*parts)->color_position, (*parts)->color_bytes);
    const auto depth = bytes_of_file(file.path(), (*parts)->depth_position, (*parts)->depth_bytes);
    check(color.has_value() && depth.has_value(), "images lie in the file");
    const auto frame = with_images->next();
    if (!frame) return;  // its depth is damaged
    check((*frame)->color == *color, "the same colour");
    check((*frame)->depth.data == sens_depth(parts_alone->header(), *depth).value().data, "the same depth");
  }
  const auto imu = parts_alone->imu_frames();
  if (!imu)
    check(imu.error().code == ErrorCode::data_corrupt, "damage of inertial frames is an error of its own");
}

}  // namespace

void sens(std::string_view bytes) {
  static const MemoryFile file("room.sens");
  file.write(bytes);
  check_frames(file);
  check_parts(file);
  const auto trajectory = read_sens_trajectory(file.path());
  if (!trajectory) {
    check(trajectory.error().code == ErrorCode::data_corrupt, "what is read can only be corrupt");
    return;
  }
  check(!trajectory->empty(), "a trajectory without poses is an error");
  for (std::size_t i = 0; i + 1 < trajectory->size(); ++i)
    check((*trajectory)[i].timestamp_ns < (*trajectory)[i + 1].timestamp_ns, "stamps rise");
}

}  // namespace fusebench::fuzz
