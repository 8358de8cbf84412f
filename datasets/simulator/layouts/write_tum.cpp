#include <fmt/format.h>

#include <iterator>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/simulator/layouts/write_lists.hpp"

namespace fusebench::simulator::layouts {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// Seconds with six decimals, as in the names of the images.
std::string stamp(std::int64_t time_ns) {
  return fmt::format("{}.{:06}", time_ns / kSecond_ns, time_ns % kSecond_ns / 1000);
}

}  // namespace

std::string tum_color_name(std::size_t, std::int64_t frame_ns) {
  return fmt::format("rgb/{}.png", stamp(frame_ns));
}

std::string tum_depth_name(std::size_t, std::int64_t frame_ns) {
  return fmt::format("depth/{}.png", stamp(frame_ns));
}

Result<void> write_tum_lists(const std::filesystem::path& folder, const SimulatedData& data) {
  std::string color = "# color images\n# simulated\n# timestamp filename\n";
  std::string depth = "# depth maps\n# simulated\n# timestamp filename\n";
  std::string both;
  for (std::size_t k = 0; k < data.frame_ns.size(); ++k) {
    const std::int64_t color_ns = data.color.stamp_ns[k];
    const std::int64_t depth_ns = data.depth.stamp_ns[k];
    const std::string color_row = fmt::format("{} {}", stamp(color_ns), tum_color_name(k, color_ns));
    const std::string depth_row = fmt::format("{} {}", stamp(depth_ns), tum_depth_name(k, depth_ns));
    if (!data.color.dropped[k]) color += color_row + "\n";
    if (!data.depth.dropped[k]) depth += depth_row + "\n";
    if (data.has_frame(k)) both += color_row + " " + depth_row + "\n";
  }
  if (auto written = write_text(folder / "rgb.txt", color); !written) return written;
  if (auto written = write_text(folder / "depth.txt", depth); !written) return written;
  if (data.paired) {
    if (auto written = write_text(folder / "associations.txt", both); !written) return written;
  }
  if (auto written = write_text(folder / "groundtruth.txt", trajectory::tum_text(data.truth)); !written)
    return written;
  return write_imu_csv(folder / "imu.csv", data.imu.samples);
}

}  // namespace fusebench::simulator::layouts
