// The lists of a ZR300 recording, all of them the same bytes.
#include "datasets/recording/formats/zr300/zr300_lists.hpp"
#include "datasets/recording/sensor_columns.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace recording;
using namespace formats::zr300;

namespace {

struct Folder {
  MemoryFile file{"TIMESTAMP.txt"};
  Folder() {
    for (const char* name : {"COLOR.txt", "DEPTH.txt", "IMU.txt", "GYRO.txt", "ACCEL.txt", "1.png", "2.png"})
      file.also_call(name);
  }
};

template <class Samples>
void check_order(const Samples& samples) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    check(samples[i].timestamp_ns > samples[i - 1].timestamp_ns, "time strictly increases");
  }
}

/// An error about one of the files in the folder.
void check_error_in(const Error& error, const std::filesystem::path& folder) {
  const std::string start = folder.string() + "/";
  check(error.message.starts_with(start), "an error begins with the name of the file");
  check_error(error, error.message.substr(0, error.message.find(':', start.size())));
}

void check_images(const Result<Zr300Images>& images, const std::filesystem::path& folder) {
  if (!images) return check_error_in(images.error(), folder);
  check(!images->color.empty() && !images->depth.empty(), "a recording has images");
  check_order(images->color);
  check_order(images->depth);
}

using ReadImu = Result<void> (*)(const std::filesystem::path& folder, Recording& recording);

void check_imu(ReadImu read, const std::filesystem::path& folder) {
  Recording recording;
  if (const auto done = read(folder, recording); !done) return check_error_in(done.error(), folder);
  check(!recording.imu.empty() && recording.imu_source == ImuSource::recorded, "an IMU has samples");
  check_order(recording.imu);
  for (const ImuSample& sample : recording.imu) {
    check(sample.angular_velocity_radps.cwiseAbs().maxCoeff() <= kMaxAngularVelocity_radps &&
              sample.specific_force_mps2.cwiseAbs().maxCoeff() <= kMaxSpecificForce_mps2,
          "samples are what a sensor can measure");
  }
}

}  // namespace

void zr300(std::string_view bytes) {
  static const Folder folder;
  folder.file.write(bytes);
  Recording recording;
  check_images(read_zr300_timestamps(folder.file.folder(), false, recording), folder.file.folder());
  check_images(read_zr300_image_lists(folder.file.folder(), false, recording), folder.file.folder());
  check_imu(read_zr300_imu, folder.file.folder());
  check_imu(read_zr300_gyro_and_accel, folder.file.folder());
}

}  // namespace fusebench::fuzz
