#include <fmt/format.h>

#include "datasets/calibration/camera_presets.hpp"
#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "datasets/simulator/layouts/layout.hpp"

namespace fusebench::simulator::layouts {

namespace {

constexpr std::string_view kZr300 = "zr300_fmdataset";

/// Scales a camera to another number of pixels with the same field of view; pixel centres are at integers.
void scale_camera(PinholeCamera& camera, const images::ImageSize& size) {
  const double x = static_cast<double>(size.width_px) / camera.width_px;
  const double y = static_cast<double>(size.height_px) / camera.height_px;
  camera = {size.width_px,
            size.height_px,
            camera.fx_px * x,
            camera.fy_px * y,
            (camera.cx_px + 0.5) * x - 0.5,
            (camera.cy_px + 0.5) * y - 0.5};
}

Result<calibration::CalibratedCamera> registered_camera(RecordingLayout layout) {
  if (layout == RecordingLayout::icl) return formats::icl::icl_calibration().color;
  auto camera = calibration::parse_camera("freiburg1");
  if (!camera) return camera;
  camera->timing = {};
  camera->ground_truth_offset_m.setZero();  // the ground truth of simulations is that of the camera
  return camera;
}

}  // namespace

Result<calibration::RigCalibration> layout_rig(RecordingLayout layout, const images::ImageSize& size) {
  if (size.width_px < 32 || size.width_px > 4096 || size.height_px < 24 || size.height_px > 4096) {
    return fail(ErrorCode::configuration, fmt::format("image size = {}x{} (allowed 32x24 .. 4096x4096)",
                                                      size.width_px, size.height_px));
  }
  auto rig = calibration::catalogue_calibration(kZr300);
  if (!rig) return rig;
  check(rig->depth.has_value() && rig->imu.has_value(),
        "the ZR300's calibration has a depth camera and an IMU");
  if (layout != RecordingLayout::zr300) {
    const auto camera = registered_camera(layout);
    if (!camera) return tl::unexpected(camera.error());
    rig->color = *camera;
    rig->depth.reset();
    rig->depth_units_per_metre = 5000;
  } else {
    scale_camera(rig->depth->pinhole, size);
  }
  scale_camera(rig->color.pinhole, size);
  // Simulated values are exact.
  rig->color.timing = {};
  rig->source = fmt::format("simulated: cameras of the {} layout, IMU of {}", to_string(layout), kZr300);
  return rig;
}

}  // namespace fusebench::simulator::layouts
