#include "datasets/recording/formats/euroc/euroc_sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/printable.hpp"
#include "datasets/recording/reading/sensor_yaml.hpp"

namespace fusebench::formats::euroc {

namespace {

using reading::SensorYaml;

constexpr double kMostPixels = 16384;
constexpr double kSameTransform = 1e-6;

/// A camera and where it is.
struct Camera {
  calibration::CalibratedCamera camera;
  SE3 T_body_camera;
};

Result<SE3> pose_in_body(const SensorYaml& yaml) {
  const auto rows = yaml.numbers("T_BS.data", 16);
  if (!rows) return tl::unexpected(rows.error());
  const auto T = calibration::rigid_transform(std::span(*rows).first<16>());
  if (T && T->translation.cwiseAbs().maxCoeff() > calibration::kMostLeverArm_m) {
    return yaml.fail_at("T_BS.data",
                        fmt::format("T_BS has a translation of {:g} m (allowed up to {} m)",
                                    T->translation.cwiseAbs().maxCoeff(), calibration::kMostLeverArm_m));
  }
  if (T) return *T;
  return yaml.fail_at("T_BS.data",
                      fmt::format("T_BS is no rigid transform ({})", calibration::kRigidTransformRule));
}

Result<Camera> read_camera(const std::filesystem::path& file) {
  const auto yaml = SensorYaml::read(file);
  if (!yaml) return tl::unexpected(yaml.error());
  if (const auto model = yaml->text("camera_model"); model && *model != "pinhole")
    return yaml->fail_at(
        "camera_model",
        fmt::format("camera_model {} is not supported (supported is pinhole)", printable(*model)));
  const auto T_body_camera = pose_in_body(*yaml);
  if (!T_body_camera) return tl::unexpected(T_body_camera.error());
  const auto k = yaml->numbers("intrinsics", 4);
  if (!k) return tl::unexpected(k.error());
  if (!((*k)[0] > 0 && (*k)[1] > 0))
    return yaml->fail_at("intrinsics", "focal lengths must be above 0 (fu, fv, cu, cv)");
  const auto size = yaml->numbers("resolution", 2);
  if (!size) return tl::unexpected(size.error());
  if (!std::ranges::all_of(*size, [](double side) { return side >= 1 && side <= kMostPixels; }))
    return yaml->fail_at("resolution", fmt::format("a side must be 1 to {} pixels", kMostPixels));
  const auto distortion = reading::yaml_distortion(*yaml, "distortion_model", "distortion_coefficients");
  if (!distortion) return tl::unexpected(distortion.error());
  return Camera{
      {{static_cast<int>((*size)[0]), static_cast<int>((*size)[1]), (*k)[0], (*k)[1], (*k)[2], (*k)[3]},
       *distortion,
       calibration::kUnknownTiming},
      *T_body_camera};
}

bool same(const Camera& a, const Camera& b) {
  return a.camera.pinhole == b.camera.pinhole &&
         pose_minus(a.T_body_camera, b.T_body_camera).norm() < kSameTransform;
}

/// Fills the depth camera, if it is another one than that of colour, and the value of one metre.
Result<void> read_depth(const std::filesystem::path& file, const Camera& color,
                        calibration::RigCalibration& calibration) {
  if (!io::is_named(file)) return {};
  const auto yaml = SensorYaml::read(file);
  if (!yaml) return tl::unexpected(yaml.error());
  if (yaml->has("depth_units_per_metre")) {
    const auto units = yaml->number("depth_units_per_metre");
    if (!units) return tl::unexpected(units.error());
    if (!calibration::is_units_per_metre(*units))
      return calibration::no_units_per_metre(ErrorCode::data_corrupt,
                                             fmt::format("{}: depth_units_per_metre", file.string()), *units);
    calibration.depth_units_per_metre = *units;
  }
  const auto depth = read_camera(file);
  if (!depth) return tl::unexpected(depth.error());
  if (same(color, *depth)) return {};
  if (!depth->camera.distortion.is_zero())
    return yaml->fail_at("distortion_coefficients", "depth of a camera of its own must have no distortion");
  calibration.depth =
      calibration::DepthCamera{depth->camera.pinhole, color.T_body_camera.inverse() * depth->T_body_camera};
  return {};
}

/// T_body_imu; nothing if there is no IMU.
Result<std::optional<SE3>> read_imu(const std::filesystem::path& file, const Camera& color,
                                    calibration::RigCalibration& calibration) {
  if (!io::is_named(file)) return std::nullopt;
  const auto yaml = SensorYaml::read(file);
  if (!yaml) return tl::unexpected(yaml.error());
  const auto T_body_imu = pose_in_body(*yaml);
  if (!T_body_imu) return tl::unexpected(T_body_imu.error());
  std::vector<double> densities;
  for (const std::string_view key : {"gyroscope_noise_density", "accelerometer_noise_density",
                                     "gyroscope_random_walk", "accelerometer_random_walk"}) {
    const auto density = yaml->number(key);
    if (!density) return tl::unexpected(density.error());
    if (!(*density >= (key.ends_with("density") ? 1e-9 : 0) && *density <= 100))
      return yaml->fail_at(key, fmt::format("{} must be a density above 0 and at most 100", key));
    densities.push_back(*density);
  }
  calibration.imu = calibration::ImuCalibration{T_body_imu->inverse() * color.T_body_camera,
                                                {densities[0], densities[1], densities[2], densities[3]}};
  return std::optional<SE3>(*T_body_imu);
}

}  // namespace

Result<EurocRig> read_euroc_rig(const std::filesystem::path& mav0) {
  const auto color = read_camera(mav0 / "cam0" / "sensor.yaml");
  if (!color) return tl::unexpected(color.error());
  EurocRig rig;
  rig.calibration.color = color->camera;
  rig.calibration.source = "sensor.yaml of each sensor";
  rig.T_body_color = color->T_body_camera;
  if (const auto read = read_depth(mav0 / "depth0" / "sensor.yaml", *color, rig.calibration); !read)
    return tl::unexpected(read.error());
  const auto T_body_imu = read_imu(mav0 / "imu0" / "sensor.yaml", *color, rig.calibration);
  if (!T_body_imu) return tl::unexpected(T_body_imu.error());
  rig.imu_is_body = *T_body_imu && pose_minus(**T_body_imu, SE3{}).norm() < kSameTransform;
  return rig;
}

}  // namespace fusebench::formats::euroc
