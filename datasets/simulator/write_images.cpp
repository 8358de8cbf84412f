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

/// The number of instants is proportional to the exposure, which keeps the steps constant. 0: by the image
/// motion.
int samples_of_exposure(const SimulationOptions& options, double exposure_s) {
  if (options.blur_samples == 0 || options.exposure_s <= 0 || exposure_s <= options.exposure_s)
    return options.blur_samples;
  const double samples = std::ceil(options.blur_samples * exposure_s / options.exposure_s);
  return std::max(options.blur_samples, static_cast<int>(std::min(samples, double{kMaxFaultSamples})));
}

/// exposure: of the controller, if there is one.
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

/// The person of a fault in front of a camera at T_color_camera.
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

/// The hand or the person in front of a camera at T_color_camera.
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

/// Input of the exposure controller: light of a coarse image of each frame, without blur.
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

/// Data common to all frames.
struct ImageContext {
  const SimulationOptions& options;
  const CaptureSetup& setup;
  const faults::Scenery& scenery;
  std::vector<sensors::FrameExposure> exposures;  // by frame; empty without a controller
  rays::RayField color_rays;
  std::optional<sensors::DepthDistortion> depth_distortion;
  Workers alone{1};  // frames are processed in parallel, not their rows

  ImageContext(const SimulationOptions& options_in, const CaptureSetup& setup_in,
               const faults::Scenery& scenery_in, const Workers& workers)
      : options(options_in), setup(setup_in), scenery(scenery_in), color_rays(options.rig.color, workers) {
    // Registered depth has the distorted pixels of the colour image.
    if (!options.rig.depth && !options.rig.color.distortion.is_zero())
      depth_distortion.emplace(options.rig.color, workers);
    if (options.auto_exposure.on) {
      exposures = sensors::controlled_exposures(options.auto_exposure,
                                                metered_light(options, setup, scenery, workers));
    }
  }

  [[nodiscard]] const render::Renderer& scene(const faults::FrameFaults& faults) const {
    return faults.no_texture ? *scenery.matt : scenery.scene;
  }

  [[nodiscard]] ColorImage color(std::size_t k, const faults::FrameFaults& faults) const {
    const auto before = object_before(options, scenery, setup, faults, SE3{});
    const sensors::ColorSensor sensor =
        color_sensor(options, faults, exposures.empty() ? nullptr : &exposures[k]);
    return sensors::expose_color(scene(faults), sensor, color_rays, setup.body, setup.T_body_color,
                                 setup.frame_ns[k], options.seed, k, alone, before ? &*before : nullptr);
  }

  [[nodiscard]] Image<std::uint16_t> depth(std::size_t k, const faults::FrameFaults& faults) const {
    const calibration::RigCalibration& rig = options.rig;
    const sensors::DepthSensor sensor = depth_sensor(options);
    if (faults.no_depth) return {sensor.camera.width_px, sensor.camera.height_px, std::uint16_t{0}};
    const SE3 T_color_depth = rig.depth ? rig.depth->T_color_depth : SE3{};
    const auto before = object_before(options, scenery, setup, faults, T_color_depth);
    const std::int64_t depth_ns = setup.frame_ns[k] + std::llround(1e9 * rig.color.timing.depth_delay_s);
    const Image<std::uint16_t> depth =
        sensors::sense_depth(scene(faults), sensor, setup.body, setup.T_body_color * T_color_depth, depth_ns,
                             options.seed, k, alone, before ? &*before : nullptr);
    return depth_distortion ? depth_distortion->distorted(depth) : depth;
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
  const ImageContext context(options, setup, scenery, workers);
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
