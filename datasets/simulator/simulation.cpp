#include "datasets/simulator/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>

#include "core/base/io/staged_folder.hpp"
#include "core/config/toml_document.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/simulator/layouts/write_lists.hpp"
#include "datasets/simulator/routes/route_motion.hpp"
#include "datasets/simulator/write_images.hpp"

namespace fusebench::simulator {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kImuTail_ns = 50'000'000;  // after the last frame, so that samples enclose it
constexpr double kLongest_s = 3600;
// With half of the longest read-out, depth is still within the motion, which continues for
// MotionSpan::kTail_ns.
constexpr double kMaxDelay_s = 0.05;
// With an uncalibrated late clock, readers require samples beyond the usual end; with the tail above, they
// are within MotionSpan::kTail_ns.
constexpr double kMaxUntold_s = 0.04;
constexpr int kTruthPerFrame = 3;  // ground-truth poses per frame, since readers interpolate

/// Some formats do not permit other rates (zr300) or number their frames (icl).
Result<void> check_rate(const SimulationOptions& o) {
  const layouts::LayoutDescription& layout = layouts::describe(o.layout);
  if (o.rate_hz >= layout.lowest_rate_hz && o.rate_hz <= layout.highest_rate_hz) return {};
  return fail(ErrorCode::configuration,
              fmt::format("rate_hz = {} (allowed in the {} layout: {} .. {})", o.rate_hz, layout.name,
                          layout.lowest_rate_hz, layout.highest_rate_hz),
              "images must have different stamps in the file format");
}

Result<void> check_options(const SimulationOptions& o) {
  for (const auto& [name, value, low, high] :
       {std::tuple{"duration_s", o.duration_s, 0.0, kLongest_s},
        std::tuple{"exposure_s", o.exposure_s, 0.0, 0.1},
        std::tuple{"blur_samples", static_cast<double>(o.blur_samples), 0.0, 256.0},
        std::tuple{"gain_drift", o.gain_drift, 0.0, 0.5}, std::tuple{"vignetting", o.vignetting, 0.0, 0.9},
        std::tuple{"read_noise_grey", o.read_noise_grey, 0.0, 50.0},
        std::tuple{"shot_noise", o.shot_noise, 0.0, 0.5},
        std::tuple{"imu_rate_hz", o.imu_rate_hz, 50.0, 2000.0},
        std::tuple{"color readout_s", o.rig.color.timing.color_readout_s, 0.0, 0.1},
        std::tuple{"depth readout_s", o.rig.color.timing.depth_readout_s, 0.0, 0.1},
        std::tuple{"depth delay_s", o.rig.color.timing.depth_delay_s, -kMaxDelay_s, kMaxDelay_s},
        std::tuple{"imu time_offset_s", o.imu.time_offset_s, -1.0, 1.0},
        std::tuple{"stamps.jitter_s", o.stamps.jitter_s, 0.0, 0.1 / o.rate_hz},
        std::tuple{"stamps.dropped_share", o.stamps.dropped_share, 0.0, 0.5},
        std::tuple{"untold_time_offset_s", o.untold_time_offset_s, -kMaxUntold_s, kMaxUntold_s}}) {
    if (!(value >= low && value <= high)) {
      return fail(ErrorCode::configuration,
                  fmt::format("{} = {} (allowed {} .. {})", name, value, low, high));
    }
  }
  if (motion::follows_route(o.preset) && o.trajectory_file.empty() && !o.scene_file.empty()) {
    return fail(ErrorCode::configuration,
                fmt::format("preset = {} follows a route through a scene of its own", to_string(o.preset)),
                "leave out the scene, or take another preset");
  }
  if (!o.rig.imu)
    return fail(ErrorCode::configuration, "the calibration has no IMU", "start from the defaults");
  if (auto valid = check_rate(o); !valid) return valid;
  if (auto valid = faults::check_calibration_error(o.calibration_error); !valid) return valid;
  return motion::check_file_motion(o.file_motion);
}

/// The selected motion of the camera, without its body.
struct Drive {
  synthetic_imu::PoseSpline camera;
  double shrunk = 1;
  double turned_rad = 0;
};

Result<scene::SimulatedScene> make_scene(const SimulationOptions& options) {
  if (!options.scene_file.empty()) return scene::read_scene(options.scene_file, options.scene);
  return make_room_of_kind(options.room, options.seed);
}

Result<std::optional<motion::FilePath>> read_path(const SimulationOptions& options) {
  if (options.trajectory_file.empty()) return std::optional<motion::FilePath>{};
  auto path = motion::read_file_path(options.trajectory_file);
  if (!path) return tl::unexpected(path.error());
  return std::optional<motion::FilePath>(std::move(*path));
}

/// Stamps of the frames.
Result<std::vector<std::int64_t>> choose_times(const SimulationOptions& options,
                                               const std::optional<motion::FilePath>& path) {
  const layouts::LayoutDescription& layout = layouts::describe(options.layout);
  double duration_s = options.duration_s;
  if (duration_s == 0 && path) {
    const double lead_s = seconds_between(0, layout.imu_lead_ns);
    duration_s = motion::longest_duration_s(*path, options.file_motion, lead_s);
    if (!(duration_s <= kLongest_s)) {
      return fail(
          ErrorCode::configuration,
          fmt::format("{}: holds {:g} s at speed {:g} (a recording has up to {:g} s)",
                      options.trajectory_file.string(), duration_s, options.file_motion.speed, kLongest_s),
          "give a duration to take the beginning of the path, or a higher speed");
    }
  }
  const auto count = static_cast<std::size_t>(std::max(0.0, std::round(duration_s * options.rate_hz)));
  if (count < 2) {
    return fail(ErrorCode::configuration,
                fmt::format("duration_s = {} holds {} frames at {} Hz (at least 2)", duration_s, count,
                            options.rate_hz),
                "take a longer recording");
  }
  std::vector<std::int64_t> frame_ns;
  for (std::size_t k = 0; k < count; ++k) frame_ns.push_back(layout.frame_ns(k, options.rate_hz));
  return frame_ns;
}

/// Applies the stamp errors of the sensors and the faults to the image lists.
void stamp_images(const SimulationOptions& options, CaptureSetup& setup) {
  const layouts::LayoutDescription& layout = layouts::describe(options.layout);
  sensors::StampErrors errors = options.stamps;
  if (!layout.has_stamps) errors.jitter_s = 0;
  const auto images_of = [&](sensors::ImageStream stream) {
    sensors::ImageStamps images =
        sensors::stamped(setup.frame_ns, errors, layout.tick_ns, options.seed, stream);
    const std::vector<bool> faulty = faults::dropped_frames(options.faults, setup.frame_ns);
    for (std::size_t k = 0; k < faulty.size(); ++k) images.dropped[k] = images.dropped[k] || faulty[k];
    return images;
  };
  setup.color = images_of(sensors::ImageStream::color);
  setup.depth = layout.separate_lists ? images_of(sensors::ImageStream::depth) : setup.color;
}

Result<Drive> choose_motion(const SimulationOptions& options, const std::optional<motion::FilePath>& path,
                            const motion::MotionSpan& span, const Eigen::AlignedBox3d& box,
                            const motion::HeadingTexture& texture) {
  if (path) {
    auto motion = motion::file_motion(*path, options.file_motion, span, box, texture);
    if (!motion) return tl::unexpected(motion.error());
    return Drive{std::move(motion->camera), motion->shrunk, motion->heading_rad};
  }
  if (motion::follows_route(options.preset))
    return Drive{routes::route_motion(options.preset, options.motion, span, box, options.seed)};
  auto camera = motion::hand_held_motion(options.motion, span, box, options.seed, texture);
  if (!camera) return tl::unexpected(camera.error());
  return Drive{std::move(*camera)};
}

/// Poses of the colour camera at each frame and at equal steps between frames.
Trajectory true_poses(const CaptureSetup& setup) {
  Trajectory truth;
  const auto add = [&](std::int64_t time_ns) {
    truth.push_back({time_ns, setup.body.evaluate(time_ns).T_world_body * setup.T_body_color});
  };
  // Adds one pose at both ends, since the capture may be slightly before or after its stamp.
  const std::int64_t step_ns = (setup.frame_ns[1] - setup.frame_ns[0]) / kTruthPerFrame;
  add(setup.frame_ns.front() - step_ns);
  for (std::size_t k = 0; k + 1 < setup.frame_ns.size(); ++k) {
    const std::int64_t spacing_ns = setup.frame_ns[k + 1] - setup.frame_ns[k];
    for (int i = 0; i < kTruthPerFrame; ++i) add(setup.frame_ns[k] + spacing_ns * i / kTruthPerFrame);
  }
  add(setup.frame_ns.back());
  add(setup.frame_ns.back() + step_ns);
  return truth;
}

/// Writes all files except the images.
Result<void> write_rest(const SimulationOptions& options, const CaptureSetup& setup,
                        const motion::MotionSpan& span, Mesh scene, const fs::path& folder,
                        SimulationReport& report) {
  layouts::SimulatedData data;
  data.rig = options.rig;
  data.rig.imu->time_offset_s = options.imu.time_offset_s;
  data.rig.imu->T_imu_camera =
      faults::miscalibrated(options.rig.imu->T_imu_camera, options.calibration_error, options.seed);
  if (options.untold_shutters) data.rig.color.timing = calibration::kUnknownTiming;
  data.frame_ns = setup.frame_ns;
  data.color = setup.color;
  data.depth = setup.depth;
  data.paired = !options.stamps.any();
  data.truth = true_poses(setup);
  sensors::ImuErrors errors = options.imu;
  errors.time_offset_s += options.untold_time_offset_s;
  const std::int64_t late_ns = std::llround(1e9 * std::max(0.0, -options.untold_time_offset_s));
  data.imu = sensors::simulate_imu(setup.body, span.begin_ns, span.last_frame_ns + kImuTail_ns + late_ns,
                                   options.imu_rate_hz, errors, options.seed);
  data.scene = std::move(scene);
  report.imu_samples = data.imu.samples.size();
  if (auto written = layouts::write_layout(options.layout, folder, data); !written) return written;
  const Vector3d gravity =
      layouts::describe(options.layout).T_file_scene(data).rotation * Vector3d(0, 0, -kGravity_mps2);
  return layouts::write_text(folder / "simulation.toml", simulation_text(options, report.identity, gravity));
}

/// True if the folder already has this complete recording, by the checks of its reader. Error usage if it has
/// other content.
Result<bool> is_there(const fs::path& folder, const std::string& identity) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return false;
  const auto document = config::read_toml(folder / "simulation.toml");
  if (document) {
    for (const config::TomlEntry& entry : document->entries) {
      const auto* value = std::get_if<config::OptionValue>(&entry.value);
      const auto* text = value != nullptr ? std::get_if<std::string>(value) : nullptr;
      if (entry.key != "identity" || text == nullptr || *text != identity) continue;
      const auto recording = datasets::open_recording(folder);
      if (recording) return true;
      return fail(
          ErrorCode::usage,
          fmt::format("{}: is this recording, but damaged: {}", folder.string(), recording.error().message),
          "remove the folder, and it is made again");
    }
  }
  return fail(ErrorCode::usage, fmt::format("{}: exists and is not the requested recording", folder.string()),
              "choose another folder, or remove this one");
}

/// "a/b/" names the same folder as "a/b".
fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace

Result<SimulationOptions> simulation_defaults(layouts::RecordingLayout layout, motion::MotionPreset preset,
                                              const images::ImageSize& size) {
  auto rig = layouts::layout_rig(layout, size);
  if (!rig) return tl::unexpected(rig.error());
  SimulationOptions options;
  options.layout = layout;
  options.preset = preset;
  options.motion = motion::motion_preset(preset);
  options.room = room_of(preset);
  options.rig = std::move(*rig);
  options.depth_noise = layouts::describe(layout).depth_noise;
  options.imu.sensor.noise = options.rig.imu->noise;
  return options;
}

void remove_noise(SimulationOptions& options) {
  options.gain_drift = 0;
  options.vignetting = 0;
  options.read_noise_grey = 0;
  options.shot_noise = 0;
  options.depth_noise = sensors::DepthNoise::none;
  options.imu.sensor = synthetic_imu::ImuSensor{"ideal", {}, 0, 0};
  options.color_processing = {};
  options.depth_errors = {};
}

Result<void> check_simulation(const SimulationOptions& options) { return check_options(options); }

Result<SimulationReport> simulate(const SimulationOptions& options, const fs::path& out,
                                  const Workers& workers, const SimulationControl& control) {
  if (const auto valid = check_options(options); !valid) return tl::unexpected(valid.error());
  const fs::path folder = without_slash(out);
  SimulationReport report;
  const auto identity = simulation_identity(options);
  if (!identity) return tl::unexpected(identity.error());
  report.identity = *identity;
  const auto there = is_there(folder, *identity);
  if (!there) return tl::unexpected(there.error());
  report.reused = *there;
  if (report.reused) return report;

  auto path = read_path(options);
  if (!path) return tl::unexpected(path.error());
  auto frame_ns = choose_times(options, *path);
  if (!frame_ns) return tl::unexpected(frame_ns.error());
  if (const auto valid = faults::check_faults(options.faults, *frame_ns); !valid)
    return tl::unexpected(valid.error());
  auto scene = make_scene(options);
  if (!scene) return tl::unexpected(scene.error());
  const motion::MotionSpan span{frame_ns->front() - layouts::describe(options.layout).imu_lead_ns,
                                frame_ns->front(), frame_ns->back()};
  const faults::Scenery scenery(*scene, options.rig.color.pinhole, options.faults, options.seed);
  motion::HeadingTexture texture = motion::look_around(scenery.scene, scene->free_space, workers);
  texture.only_rad = scene->heading_rad;
  texture.face_rad = scene->face_rad;
  const auto drive = choose_motion(options, *path, span, scene->free_space, texture);
  if (!drive) return tl::unexpected(drive.error());
  const SE3& T_body_color = options.rig.imu->T_imu_camera;
  CaptureSetup setup{motion::body_motion(drive->camera, T_body_color), T_body_color, std::move(*frame_ns)};
  stamp_images(options, setup);
  report.frames = static_cast<std::size_t>(std::ranges::count(setup.color.dropped, false));
  report.trajectory_shrunk = drive->shrunk;
  report.trajectory_turned_rad = drive->turned_rad;
  if (*path) report.warnings = (*path)->warnings;
  report.peaks = motion::peak_speeds(setup.body, T_body_color, span.first_frame_ns, span.last_frame_ns);

  auto staged = io::StagedFolder::create(folder);
  if (!staged) return tl::unexpected(staged.error());
  if (auto written = write_images(options, setup, scenery, staged->path(), workers, control); !written)
    return tl::unexpected(written.error());
  if (auto written = write_rest(options, setup, span, std::move(scene->mesh), staged->path(), report);
      !written)
    return tl::unexpected(written.error());
  if (const auto committed = staged->commit(); !committed) return tl::unexpected(committed.error());
  return report;
}

}  // namespace fusebench::simulator
