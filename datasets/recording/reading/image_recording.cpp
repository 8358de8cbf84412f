#include "datasets/recording/reading/image_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/calibration/depth_registration.hpp"
#include "datasets/calibration/scaled_camera.hpp"
#include "datasets/recording/calibration_checks.hpp"

namespace fusebench::reading {

namespace {

/// Data for loading frames; shared by all copies of the recording.
struct FrameLoader {
  std::vector<recording::FrameEntry> frames;
  std::vector<ImageHashes> opened;  ///< of each frame's images, as the fingerprint has them
  calibration::Undistortion undistortion;
  std::optional<calibration::DepthRegistration> registration;
  ImageSource images;

  [[nodiscard]] Result<DepthImage> load_depth(std::size_t index) const {
    const PinholeCamera& own = registration ? registration->depth_camera() : undistortion.camera();
    auto depth = images.read_depth(index, {own.width_px, own.height_px}, opened[index].depth);
    if (!depth) return depth;
    return registration ? registration->register_depth(*depth) : undistortion.undistort_depth(*depth);
  }

  [[nodiscard]] Result<RgbdFrame> load(std::size_t index) const {
    check(index < frames.size(), "the frame exists");
    const recording::FrameEntry& entry = frames[index];
    const PinholeCamera& camera = undistortion.camera();
    const auto color = images.read_color(index, {camera.width_px, camera.height_px}, opened[index].color);
    if (!color) return tl::unexpected(color.error());
    auto depth = load_depth(index);
    if (!depth) return tl::unexpected(depth.error());
    RgbdFrame frame;
    frame.timestamp_ns = entry.timestamp_ns;
    frame.capture_offset_ns = entry.capture_ns - entry.timestamp_ns;
    frame.depth_offset_ns = entry.depth_capture_ns - entry.capture_ns;
    frame.color = undistortion.undistort_color(*color);
    frame.grey = to_grey(frame.color);
    frame.depth_m = std::move(*depth);
    return frame;
  }
};

/// The camera with the images' size; a calibration of another size is an error.
Result<calibration::CalibratedCamera> camera_of_images(calibration::CalibratedCamera camera,
                                                       const ImageSource& images,
                                                       const std::string& first_image) {
  const auto size = images.color_size();
  if (!size) return tl::unexpected(size.error());
  PinholeCamera& pinhole = camera.pinhole;
  if (pinhole.width_px == 0) {
    pinhole.width_px = size->width_px;
    pinhole.height_px = size->height_px;
  }
  if (*size != images::ImageSize{pinhole.width_px, pinhole.height_px}) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: image of {}x{} pixels, but the camera's calibration is for {}x{}", first_image,
                    size->width_px, size->height_px, pinhole.width_px, pinhole.height_px),
        "give the intrinsics of these images: --camera fx,fy,cx,cy[,k1,k2,p1,p2,k3]");
  }
  return camera;
}

/// Refused once, and not in every frame.
Result<void> check_depth_size(const recording::Recording& recording,
                              const calibration::RigCalibration& calibration, const PinholeCamera& color,
                              const ImageSource& images) {
  const auto size = images.depth_size();
  const PinholeCamera& camera = calibration.depth ? calibration.depth->pinhole : color;
  if (!size || *size == images::ImageSize{camera.width_px, camera.height_px}) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}: depth of {}x{} pixels, but {} has {}x{}", recording.name, size->width_px,
                  size->height_px,
                  calibration.depth ? "the depth camera of the calibration"
                                    : "colour, to which depth without a camera of its own is registered,",
                  camera.width_px, camera.height_px),
      "give depth a camera of its own in [depth] of a calibration.toml: width_px, height_px, fx_px, "
      "fy_px, cx_px, cy_px and T_color_depth");
}

std::string text_of(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string text_of(const SE3& T) {
  const Quaterniond& q = T.rotation;
  return fmt::format("{} {} {} {} {}", text_of(T.translation), q.x(), q.y(), q.z(), q.w());
}

std::string text_of(const PinholeCamera& p) {
  return fmt::format("{} {} {} {} {} {}", p.width_px, p.height_px, p.fx_px, p.fy_px, p.cx_px, p.cy_px);
}

void add_sensors(io::Fingerprint& fingerprint, const recording::Recording& recording,
                 const calibration::RigCalibration& calibration, const std::string& identity,
                 const calibration::CalibratedCamera& camera) {
  const calibration::BrownConrady& d = camera.distortion;
  const SensorTiming& timing = camera.timing;
  fingerprint.add(fmt::format("{} {} {} {} {} {} {} {} {} {} {}", recording.format, identity,
                              text_of(camera.pinhole), d.k1, d.k2, d.p1, d.p2, d.k3, timing.color_readout_s,
                              timing.depth_readout_s, timing.depth_delay_s));
  if (timing.color_readout_sigma_s > 0 || timing.depth_readout_sigma_s > 0 ||
      timing.depth_delay_sigma_s > 0) {
    fingerprint.add(fmt::format("timing sigmas {} {} {}", timing.color_readout_sigma_s,
                                timing.depth_readout_sigma_s, timing.depth_delay_sigma_s));
  }
  if (!camera.ground_truth_offset_m.isZero(0))
    fingerprint.add(fmt::format("ground truth offset {}", text_of(camera.ground_truth_offset_m)));
  if (const auto& depth = calibration.depth) {
    fingerprint.add(
        fmt::format("depth camera {} {}", text_of(depth->pinhole), text_of(depth->T_color_depth)));
  }
  if (recording.imu_source == recording::ImuSource::none) return;
  const ImuNoise& noise = recording.rig.imu_noise;
  fingerprint.add(fmt::format("imu {} {} {} {} {}", text_of(recording.rig.T_imu_camera),
                              noise.gyroscope_radps_sqrthz, noise.accelerometer_mps2_sqrthz,
                              noise.gyroscope_bias_radps2_sqrthz, noise.accelerometer_bias_mps3_sqrthz));
}

void add_samples(io::Fingerprint& fingerprint, const recording::Recording& recording) {
  for (const StampedPose& pose : recording.ground_truth) {
    fingerprint.add(fmt::format("truth {} {}", pose.timestamp_ns, text_of(pose.T_world_camera)));
  }
  for (const recording::AccelerometerSample& sample : recording.accelerometer) {
    fingerprint.add(
        fmt::format("accelerometer {} {}", sample.timestamp_ns, text_of(sample.specific_force_mps2)));
  }
  for (const ImuSample& sample : recording.imu) {
    fingerprint.add(fmt::format("imu {} {} {}", sample.timestamp_ns, text_of(sample.angular_velocity_radps),
                                text_of(sample.specific_force_mps2)));
  }
}

/// Data that the fingerprint is made of.
struct Identity {
  std::string fingerprint;
  std::vector<ImageHashes> images;  ///< of each frame
};

/// The values that are used, not the text around them: a comment or a line ending does not make another
/// recording.
Result<Identity> identity_of(const recording::Recording& recording, io::Fingerprint fingerprint,
                             const ImageSource& images) {
  Identity identity;
  identity.images.reserve(recording.frames.size());
  add_samples(fingerprint, recording);
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    const recording::FrameEntry& frame = recording.frames[k];
    fingerprint.add(fmt::format("frame {} {} {} {}", frame.timestamp_ns, frame.depth_timestamp_ns,
                                frame.capture_ns, frame.depth_capture_ns));
    const auto hashes = images.add_to(k, fingerprint);
    if (!hashes) return tl::unexpected(hashes.error());
    identity.images.push_back(*hashes);
  }
  identity.fingerprint = fingerprint.hex();
  return identity;
}

/// The IMU must overlap the images: an IMU of another time is an error, one that begins late or ends early a
/// warning.
Result<void> check_imu_overlap(recording::Recording& recording) {
  const std::int64_t first_ns = recording.imu.front().timestamp_ns;
  const std::int64_t last_ns = recording.imu.back().timestamp_ns;
  const std::int64_t begin_ns = recording.frames.front().timestamp_ns;
  const std::int64_t end_ns = recording.frames.back().timestamp_ns;
  if (first_ns > end_ns || last_ns < begin_ns) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: inertial samples (times {} to {}) do not overlap the images (times {} to {})",
                    recording.name, trajectory::stamp_text(first_ns), trajectory::stamp_text(last_ns),
                    trajectory::stamp_text(begin_ns), trajectory::stamp_text(end_ns)),
        "both must be of one recording, in the format's unit of time; clocks that differ by a constant need "
        "time_offset_s in [imu] of calibration.toml");
  }
  const auto outside = std::ranges::count_if(recording.frames, [&](const recording::FrameEntry& frame) {
    return frame.timestamp_ns < first_ns || frame.timestamp_ns > last_ns;
  });
  if (outside > 0) {
    recording.warnings.push_back(
        fmt::format("{}: {} of {} frames are before the first or after the last inertial sample",
                    recording.name, outside, recording.frames.size()));
  }
  return {};
}

/// From here on the IMU's stamps are on the images' clock. Samples without calibration are not used.
Result<void> calibrate_imu(recording::Recording& recording,
                           const std::optional<calibration::ImuCalibration>& imu) {
  if (!imu && recording.imu_source == recording::ImuSource::recorded) {
    recording.imu.clear();
    recording.imu_source = recording::ImuSource::none;
    recording.warnings.push_back(fmt::format(
        "{}: the inertial samples are not used, since nothing says where the IMU sits and how noisy it "
        "is: put a calibration.toml with [color] and [imu] (T_imu_color, noise densities) beside them",
        recording.name));
  }
  if (!imu) return {};
  recording.rig.T_imu_camera = imu->T_imu_camera;
  recording.rig.imu_noise = imu->noise;
  const std::int64_t offset_ns = std::llround(1e9 * imu->time_offset_s);
  for (ImuSample& sample : recording.imu) {
    sample.timestamp_ns -= offset_ns;
    sample.angular_velocity_radps.array() /= imu->gyroscope_scale.array();
    sample.specific_force_mps2.array() /= imu->accelerometer_scale.array();
  }
  return recording.imu.empty() ? Result<void>{} : check_imu_overlap(recording);
}

}  // namespace

Result<void> attach_images(recording::Recording& recording, const ImageDecoding& decoding) {
  return attach_images(recording, decoding.calibration, decoding.identity,
                       image_files(recording.frames, decoding.read_depth));
}

Result<void> attach_images(recording::Recording& recording, const calibration::RigCalibration& calibration,
                           const std::string& identity, const ImageSource& source) {
  check(!recording.frames.empty(), "a recording has frames");
  const std::filesystem::path& first_image = recording.frames.front().color_file;
  const auto camera = camera_of_images(calibration.color, source,
                                       first_image.empty() ? recording.name : first_image.string());
  if (!camera) return tl::unexpected(camera.error());
  if (auto fits = check_depth_size(recording, calibration, camera->pinhole, source); !fits) return fits;
  const std::int64_t depth_delay_ns = std::llround(1e9 * camera->timing.depth_delay_s);
  for (recording::FrameEntry& frame : recording.frames) frame.depth_capture_ns += depth_delay_ns;
  if (auto calibrated = calibrate_imu(recording, calibration.imu); !calibrated) return calibrated;
  recording.calibration = calibration;
  recording.calibration->color = *camera;
  if (auto sane = recording::check_calibration(*recording.calibration, recording); !sane) return sane;
  recording.rig.camera = camera->pinhole;
  recording.rig.timing = camera->timing;
  io::Fingerprint fingerprint;
  add_sensors(fingerprint, recording, calibration, identity, *camera);
  auto data = identity_of(recording, std::move(fingerprint), source);
  if (!data) return tl::unexpected(data.error());
  recording.fingerprint = std::move(data->fingerprint);
  std::optional<calibration::DepthRegistration> registration;
  if (calibration.depth) {
    registration.emplace(calibration.depth->pinhole, camera->pinhole, calibration.depth->T_color_depth);
  }
  const auto loader = std::make_shared<const FrameLoader>(
      FrameLoader{recording.frames, std::move(data->images), calibration::Undistortion(*camera),
                  std::move(registration), source});
  recording.load_frame = [loader](std::size_t frame) { return loader->load(frame); };
  return {};
}

void complete_depth_camera(calibration::RigCalibration& calibration, const images::ImageSize& color,
                           const images::ImageSize& depth) {
  if (calibration.depth || color == depth) return;
  PinholeCamera view = calibration.color.pinhole;
  if (view.width_px == 0) {
    view.width_px = color.width_px;
    view.height_px = color.height_px;
  }
  calibration.depth =
      calibration::DepthCamera{calibration::scaled_camera(view, depth.width_px, depth.height_px), SE3{}};
}

double settled_depth_units(calibration::RigCalibration& calibration, double published_units_per_metre) {
  const double units = calibration.depth_units_per_metre.value_or(published_units_per_metre);
  calibration.depth_units_per_metre = units;
  return units;
}

Result<recording::Recording> with_png_images(recording::Recording recording,
                                             calibration::RigCalibration calibration,
                                             double published_units_per_metre) {
  const double units = settled_depth_units(calibration, published_units_per_metre);
  const auto attached =
      attach_images(recording, {std::move(calibration), png_depth(units), fmt::format("png {}", units)});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench::reading
