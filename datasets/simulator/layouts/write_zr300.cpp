#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/simulator/layouts/write_lists.hpp"

namespace fusebench::simulator::layouts {

namespace {

std::int64_t microseconds(std::int64_t time_ns) {
  return std::llround(static_cast<double>(time_ns) / 1000);  // exact, since device clocks start near zero
}

}  // namespace

std::string zr300_color_name(std::size_t, std::int64_t frame_ns) {
  return fmt::format("color/{}.png", microseconds(frame_ns));
}

std::string zr300_depth_name(std::size_t, std::int64_t frame_ns) {
  return fmt::format("depth/{}.png", microseconds(frame_ns));
}

Result<void> write_zr300_lists(const std::filesystem::path& folder, const SimulatedData& data) {
  std::string images = "#timestamp(us) colorname depthname\n";
  for (std::size_t k = 0; k < data.frame_ns.size(); ++k) {
    if (!data.has_frame(k)) continue;
    const std::int64_t time_us = microseconds(data.color.stamp_ns[k]);
    fmt::format_to(std::back_inserter(images), "{},{}.png,{}.png\n", time_us, time_us, time_us);
  }
  std::string imu = "#timestamp(us) gx gy gz ax ay az\n";
  for (const ImuSample& sample : data.imu.samples) {
    const Vector3d& w = sample.angular_velocity_radps;
    const Vector3d& a = sample.specific_force_mps2;
    fmt::format_to(std::back_inserter(imu), "{},{},{},{},{},{},{}\n", microseconds(sample.timestamp_ns),
                   w.x(), w.y(), w.z(), a.x(), a.y(), a.z());
  }
  if (auto written = write_text(folder / "TIMESTAMP.txt", images); !written) return written;
  if (auto written = write_text(folder / "IMU.txt", imu); !written) return written;
  return write_text(folder / "groundtruth.txt", trajectory::tum_text(data.truth));
}

}  // namespace fusebench::simulator::layouts
