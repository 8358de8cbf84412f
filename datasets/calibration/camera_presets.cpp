#include "datasets/calibration/camera_presets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/io/text_table.hpp"
#include "core/base/nearest_name.hpp"

namespace fusebench::calibration {

namespace {

constexpr std::string_view kDefaultName = "default";

// Read-out times of a Kinect: 26.1 ms colour, 30.5 ms depth (Ringaby & Forssen, Scan rectification for
// structured light range sensors with rolling shutters, ICCV 2011). The delay of depth was measured for this
// project on 8 s of freiburg1_rpy: frames that see the same place while turning in opposite directions,
// warped onto each other by the ground truth, agree best in depth (12.3 -> 5.5 mm median) and in colour (45
// -> 30 grey levels) with these read-outs and depth taken 18 ms earlier than the stamps say. The Xtion of
// freiburg3 has the same sensors; its delay was not measured apart. The uncertainties are those of other
// devices and recordings: drivers stamp as they like.
constexpr SensorTiming kPrimeSense{0.0261, 0.0305, -0.018, 0.002, 0.002, 0.005};

// Where the camera is in the body that the motion capture of freiburg1 tracks: the fitted offset of `no-imu`,
// which no ground truth enters, on 8 s of freiburg1_rpy, (0.034, 0.003, 0.014) +- (0.006, 0.007, 0.005) m
// (docs/metrics.md).
const Vector3d kFreiburg1Offset_m(0.034, 0.003, 0.014);

// The images of freiburg3 are published without distortion.
const std::array<CameraPreset, 4> kPresets = {{
    {"freiburg1",
     "TUM RGB-D, Kinect of the fr1 recordings",
     {{640, 480, 517.306408, 516.469215, 318.643040, 255.313989},
      {0.262383, -0.953104, -0.005358, 0.002628, 1.163314},
      kPrimeSense,
      kFreiburg1Offset_m}},
    {"freiburg2",
     "TUM RGB-D, Kinect of the fr2 recordings",
     {{640, 480, 520.908620, 521.007327, 325.141442, 249.701764},
      {0.231222, -0.784899, -0.003257, -0.000105, 0.917205},
      kPrimeSense}},
    {"freiburg3",
     "TUM RGB-D, Xtion of the fr3 recordings",
     {{640, 480, 535.4, 539.2, 320.1, 247.6}, {}, kPrimeSense}},
    {kDefaultName,
     "the driver's default for Kinect and Xtion, not calibrated",
     {{640, 480, 525, 525, 319.5, 239.5}, {}, kPrimeSense}},
}};

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const CameraPreset& preset : kPresets) names.push_back(preset.name);
  return names;
}

constexpr double kMaxCameraParameter = 1e6;  // pixels, or of a coefficient of distortion

Result<CalibratedCamera> camera_from_numbers(std::string_view text,
                                             const std::vector<std::string_view>& fields) {
  std::array<double, 9> value{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Result<double> number = io::parse_number(fields[i]);
    if (!number)
      return fail(ErrorCode::configuration, fmt::format("camera = {}: {}", text, number.error().message));
    if (std::abs(*number) > kMaxCameraParameter) {
      return fail(ErrorCode::configuration,
                  fmt::format("camera = {}: {} (allowed {:g} .. {:g})", text, fields[i], -kMaxCameraParameter,
                              kMaxCameraParameter));
    }
    value[i] = *number;
  }
  if (value[0] <= 0 || value[1] <= 0) {
    return fail(ErrorCode::configuration, fmt::format("camera = {}: focal lengths must be positive", text),
                "images are stored top down, so fy is positive even where a renderer's is not");
  }
  return CalibratedCamera{{0, 0, value[0], value[1], value[2], value[3]},
                          {value[4], value[5], value[6], value[7], value[8]},
                          kUnknownTiming};
}

}  // namespace

std::span<const CameraPreset> camera_presets() { return kPresets; }

Result<CalibratedCamera> parse_camera(std::string_view text) {
  for (const CameraPreset& preset : kPresets) {
    if (preset.name == text) return preset.camera;
  }
  std::vector<std::string_view> fields;
  io::split_fields(text, fields);
  if (fields.size() == 4 || fields.size() == 9) return camera_from_numbers(text, fields);
  return fail(ErrorCode::configuration,
              fmt::format("camera = {} (allowed {}, or fx,fy,cx,cy[,k1,k2,p1,p2,k3])", text,
                          fmt::join(preset_names(), ", ")),
              did_you_mean(text, preset_names()));
}

std::optional<CalibratedCamera> camera_by_folder_name(std::string_view folder_name) {
  for (const CameraPreset& preset : kPresets) {
    if (preset.name != kDefaultName && folder_name.find(preset.name) != std::string_view::npos)
      return preset.camera;
  }
  return std::nullopt;
}

}  // namespace fusebench::calibration
