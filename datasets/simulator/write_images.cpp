#include "datasets/simulator/write_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "datasets/images/image_files.hpp"
#include "datasets/simulator/faults/person.hpp"
#include "datasets/simulator/sensors/depth_distortion.hpp"
#include "datasets/simulator/sensors/image_sensors.hpp"

namespace fusebench::simulator {

namespace {

constexpr int kMaxFaultSamples = 64;

/// A longer exposure is made of more instants, so that the steps between them stay as small.
int samples_of_exposure(const SimulationOptions& options, double exposure_s) {
  if (options.exposure_s <= 0 || exposure_s <= options.exposure_s) return options.blur_samples;
  const double samples = std::ceil(options.blur_samples * exposure_s / options.exposure_s);
  return std::max(options.blur_samples, static_cast<int>(std::min(samples, double{kMaxFaultSamples})));
}

/// Steps of about two pixels by the camera's turning, within limits.
int samples_of_motion(const SimulationOptions& options, const CaptureSetup& setup, std::int64_t capture_ns,
                      double exposure_s) {
  constexpr double kStep_px = 2;
  constexpr double kFewest = 4;
  constexpr double kMost = 32;
  const double rate_radps = setup.body.evaluate(capture_ns).angular_velocity_body_radps.norm();
  const double blur_px = rate_radps * exposure_s * options.rig.color.pinhole.fx_px;
  return static_cast<int>(std::clamp(std::ceil(blur_px / kStep_px), kFewest, kMost));
}

/// exposure: that of the controller, if there is one.
sensors::ColorSensor color_sensor(const SimulationOptions& options, const faults::FrameFaults& faults,
                                  const sensors::FrameExposure* exposure) {
  sensors::ColorSensor sensor;
  sensor.camera = options.rig.color;
  const double usual_s = exposure != nullptr ? exposure->exposure_s : options.exposure_s;
  sensor.exposure_s = faults.exposure_s.value_or(usual_s);
  sensor.processing = options.color_processing;
  sensor.gain_drift = options.gain_drift;
  sensor.vignetting = options.vignetting;
  sensor.read_noise_grey = options.read_noise_grey;
  sensor.shot_noise = options.shot_noise;
  sensor.blur_samples = samples_of_exposure(options, sensor.exposure_s);
  sensor.gain = faults.brightness;
  if (exposure != nullptr) {
    sensor.gain *= exposure->gain * usual_s / options.auto_exposure.unit_exposure_s;
    sensor.amplifier_gain = exposure->gain;
  }
  sensor.covered = faults.black;
  return sensor;
}

sensors::DepthSensor depth_sensor(const SimulationOptions& options) {
  const calibration::RigCalibration& rig = options.rig;
  sensors::DepthSensor sensor;
  sensor.camera = rig.depth ? rig.depth->pinhole : rig.color.pinhole;
  sensor.readout_s = rig.color.timing.depth_readout_s;
  sensor.units_per_metre = rig.depth_units_per_metre.value_or(1000);
  sensor.noise = options.depth_noise;
  sensor.errors = options.depth_errors;
  return sensor;
}

/// The person that a fault sends through the view of a camera that is placed by T_color_camera.
sensors::MovingObject walking_person(const faults::Scenery& scenery, const CaptureSetup& setup,
                                     const faults::SimulatedFault& fault, const SE3& T_color_camera) {
  const std::int64_t first_ns = setup.frame_ns.front();
  const double last_s = seconds_between(first_ns, setup.frame_ns.back());
  const double middle_s = 0.5 * (fault.begin_s + std::min(fault.end_s, last_s));
  const auto T_world_color = [&setup](std::int64_t t_ns) {
    return setup.body.evaluate(t_ns).T_world_body * setup.T_body_color;
  };
  const faults::PersonWalk walk(T_world_color(first_ns + std::llround(1e9 * middle_s)), middle_s,
                                fault.amount, scenery.floor_m);
  return {*scenery.person, [=](std::int64_t t_ns) {
            const SE3 T_world_person = walk.T_world_person(seconds_between(first_ns, t_ns));
            return T_world_person.inverse() * T_world_color(t_ns) * T_color_camera;
          }};
}

/// The hand or the person before a camera that is placed by T_color_camera.
std::optional<sensors::MovingObject> object_before(const SimulationOptions& options,
                                                   const faults::Scenery& scenery, const CaptureSetup& setup,
                                                   const faults::FrameFaults& faults,
                                                   const SE3& T_color_camera) {
  if (faults.person) return walking_person(scenery, setup, options.faults[*faults.person], T_color_camera);
  if (!faults.hand) return std::nullopt;
  const faults::Scenery::MovingHand& moving = *scenery.hands[*faults.hand];
  return sensors::MovingObject{moving.surface, [&, T_color_camera](std::int64_t t_ns) {
                                 const double time_s = seconds_between(setup.frame_ns.front(), t_ns);
                                 return moving.hand.T_color_hand(time_s).inverse() * T_color_camera;
                               }};
}

/// Data common to all frames.
struct ImageContext {
  const SimulationOptions& options;
  const CaptureSetup& setup;
  const faults::Scenery& scenery;
  std::vector<sensors::FrameExposure> exposures;  // by frame; empty without a controller
  Workers alone{1};                               // frames are what runs in parallel

  [[nodiscard]] const render::Renderer& scene(const faults::FrameFaults& faults) const {
    return faults.no_texture ? *scenery.matt : scenery.scene;
  }

  [[nodiscard]] ColorImage color(std::size_t k, const faults::FrameFaults& faults) const {
    const auto before = object_before(options, scenery, setup, faults, SE3{});
    sensors::ColorSensor sensor = color_sensor(options, faults, exposures.empty() ? nullptr : &exposures[k]);
    if (options.samples_by_motion)
      sensor.blur_samples = samples_of_motion(options, setup, setup.frame_ns[k], sensor.exposure_s);
    return sensors::expose_color(scene(faults), sensor, setup.body, setup.T_body_color, setup.frame_ns[k],
                                 options.seed, k, alone, before ? &*before : nullptr);
  }

  [[nodiscard]] Image<std::uint16_t> depth(std::size_t k, const faults::FrameFaults& faults) const {
    const calibration::RigCalibration& rig = options.rig;
    const sensors::DepthSensor sensor = depth_sensor(options);
    if (faults.no_depth) return {sensor.camera.width_px, sensor.camera.height_px, std::uint16_t{0}};
    const SE3 T_color_depth = rig.depth ? rig.depth->T_color_depth : SE3{};
    const auto before = object_before(options, scenery, setup, faults, T_color_depth);
    const std::int64_t depth_ns = setup.frame_ns[k] + std::llround(1e9 * rig.color.timing.depth_delay_s);
    Image<std::uint16_t> depth =
        sensors::sense_depth(scene(faults), sensor, setup.body, setup.T_body_color * T_color_depth, depth_ns,
                             options.seed, k, alone, before ? &*before : nullptr);
    // Registered depth has the pixels of the colour image, which are distorted.
    if (!rig.depth && !rig.color.distortion.is_zero()) depth = sensors::distort_depth(depth, rig.color);
    return depth;
  }
};

Result<void> write_frame(const ImageContext& context, std::size_t k, const std::filesystem::path& folder) {
  const layouts::LayoutDescription& layout = layouts::describe(context.options.layout);
  const std::vector<std::int64_t>& frame_ns = context.setup.frame_ns;
  const faults::FrameFaults faults =
      faults::faults_at(context.options.faults, frame_ns[k] - frame_ns.front());
  const CaptureSetup& setup = context.setup;
  if (!setup.color.dropped[k]) {
    const auto color =
        images::write_png(folder / layout.color_name(k, setup.color.stamp_ns[k]), context.color(k, faults));
    if (!color) return color;
  }
  if (setup.depth.dropped[k]) return {};
  return images::write_png(folder / layout.depth_name(k, setup.depth.stamp_ns[k]), context.depth(k, faults));
}

/// What the exposure controller meters: the light of a coarse image of each frame, without blur.
std::vector<std::vector<float>> metered_light(const SimulationOptions& options, const CaptureSetup& setup,
                                              const faults::Scenery& scenery, const Workers& workers) {
  constexpr int kWidth_px = 40;
  constexpr int kHeight_px = 30;
  const PinholeCamera& camera = options.rig.color.pinhole;
  const double scale_x = static_cast<double>(kWidth_px) / camera.width_px;
  const double scale_y = static_cast<double>(kHeight_px) / camera.height_px;
  const PinholeCamera meter{kWidth_px,
                            kHeight_px,
                            camera.fx_px * scale_x,
                            camera.fy_px * scale_y,
                            (camera.cx_px + 0.5) * scale_x - 0.5,
                            (camera.cy_px + 0.5) * scale_y - 0.5};
  std::vector<std::vector<float>> light_of_frame(setup.frame_ns.size());
  workers.for_chunks(setup.frame_ns.size(), 1, [&](std::size_t k, std::size_t) {
    const std::int64_t t_ns = setup.frame_ns[k];
    const SE3 T_world_camera = setup.body.evaluate(t_ns).T_world_body * setup.T_body_color;
    const faults::FrameFaults faults = faults::faults_at(options.faults, t_ns - setup.frame_ns.front());
    const render::Renderer& scene = faults.no_texture ? *scenery.matt : scenery.scene;
    Image<Eigen::Vector3f> light;
    scene.render_light(meter, {{T_world_camera}}, Vector2d::Zero(), Workers(1), light);
    for (const Eigen::Vector3f& pixel : light.data)
      light_of_frame[k].push_back(faults.black ? 0.0F : pixel.mean());
  });
  return light_of_frame;
}

Result<void> create_folders(const layouts::LayoutDescription& layout, const std::filesystem::path& folder) {
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

Result<void> write_images(const SimulationOptions& options, const CaptureSetup& setup,
                          const faults::Scenery& scenery, const std::filesystem::path& folder,
                          const Workers& workers, const SimulationControl& control) {
  if (auto created = create_folders(layouts::describe(options.layout), folder); !created) return created;
  std::vector<sensors::FrameExposure> exposures;
  if (options.auto_exposure.on) {
    exposures =
        sensors::controlled_exposures(options.auto_exposure, metered_light(options, setup, scenery, workers));
  }
  const ImageContext context{options, setup, scenery, std::move(exposures)};
  const std::size_t count = setup.frame_ns.size();
  std::vector<std::optional<Error>> errors(count);
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::size_t done = 0;
  workers.for_chunks(count, 1, [&](std::size_t k, std::size_t) {
    if (failed || (control.stop != nullptr && *control.stop)) return;
    if (const auto written = write_frame(context, k, folder); !written) {
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

}  // namespace fusebench::simulator
