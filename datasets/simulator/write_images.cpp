#include "datasets/simulator/write_images.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <system_error>

#include "datasets/image_files.hpp"
#include "datasets/simulator/depth_distortion.hpp"
#include "datasets/simulator/image_sensors.hpp"

namespace fusebench {

namespace {

ColorSensor color_sensor(const SimulationOptions& options) {
  ColorSensor sensor;
  sensor.camera = options.rig.color;
  sensor.exposure_s = options.exposure_s;
  sensor.gain_drift = options.gain_drift;
  sensor.vignetting = options.vignetting;
  sensor.read_noise_grey = options.read_noise_grey;
  sensor.shot_noise = options.shot_noise;
  sensor.blur_samples = options.blur_samples;
  return sensor;
}

DepthSensor depth_sensor(const SimulationOptions& options) {
  const RigCalibration& rig = options.rig;
  DepthSensor sensor;
  sensor.camera = rig.depth ? rig.depth->pinhole : rig.color.pinhole;
  sensor.readout_s = rig.color.timing.depth_readout_s;
  sensor.units_per_metre = rig.depth_units_per_metre.value_or(1000);
  sensor.noise = options.depth_noise;
  return sensor;
}

Result<void> write_frame(const SimulationOptions& options, const Shooting& shooting, const Renderer& renderer,
                         std::size_t k, const std::filesystem::path& folder) {
  const LayoutDescription& layout = describe(options.layout);
  const RigCalibration& rig = options.rig;
  const Workers alone(1);  // frames are what runs in parallel
  const std::int64_t time_ns = shooting.frame_ns[k];
  const SE3& T_body_color = shooting.T_body_color;
  const ColorImage image = expose_color(renderer, color_sensor(options), shooting.body, T_body_color, time_ns,
                                        options.seed, k, alone);
  if (auto written = write_png(folder / layout.color_name(k, time_ns), image); !written) return written;

  const SE3 T_body_depth = rig.depth ? T_body_color * rig.depth->T_color_depth : T_body_color;
  const std::int64_t depth_ns = time_ns + std::llround(1e9 * rig.color.timing.depth_delay_s);
  Image<std::uint16_t> depth = sense_depth(renderer, depth_sensor(options), shooting.body, T_body_depth,
                                           depth_ns, options.seed, k, alone);
  // Registered depth has the pixels of the colour image, which are distorted.
  if (!rig.depth && !rig.color.distortion.is_zero()) depth = distort_depth(depth, rig.color);
  return write_png(folder / layout.depth_name(k, time_ns), depth);
}

Result<void> create_folders(const LayoutDescription& layout, const std::filesystem::path& folder) {
  for (const std::string& name : {layout.color_name(0, 0), layout.depth_name(0, 0)}) {
    const std::filesystem::path images = (folder / name).parent_path();
    std::error_code error;
    std::filesystem::create_directories(images, error);
    if (error) {
      return fail(ErrorCode::io, fmt::format("{}: cannot be created: {}", images.string(), error.message()));
    }
  }
  return {};
}

}  // namespace

Result<void> write_images(const SimulationOptions& options, const Shooting& shooting,
                          const Renderer& renderer, const std::filesystem::path& folder,
                          const Workers& workers, const SimulationControl& control) {
  if (auto created = create_folders(describe(options.layout), folder); !created) return created;
  const std::size_t count = shooting.frame_ns.size();
  std::vector<std::optional<Error>> errors(count);
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::size_t done = 0;
  workers.for_chunks(count, 1, [&](std::size_t k, std::size_t) {
    if (failed || (control.stop != nullptr && *control.stop)) return;
    if (const auto written = write_frame(options, shooting, renderer, k, folder); !written) {
      errors[k] = written.error();
      failed = true;
      return;
    }
    const std::scoped_lock lock(mutex);
    ++done;
    if (control.progress) control.progress(done, count);
  });
  for (const auto& error : errors) {
    if (error) return tl::unexpected(*error);
  }
  if (done < count) return fail(ErrorCode::run_failed, "the simulation was stopped; nothing was written");
  return {};
}

}  // namespace fusebench
