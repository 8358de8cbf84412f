// A program that uses the estimator: a textured wall at 1.5 m, before which the camera moves 5 mm a frame
// along x.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>

#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "core/recording_estimator.hpp"

namespace {

fusebench::PinholeCamera camera() { return {160, 120, 130, 130, 79.5, 59.5}; }

fusebench::RgbdFrame frame_at(int number, double x_m) {
  const fusebench::PinholeCamera pinhole = camera();
  fusebench::RgbdFrame frame;
  frame.timestamp_ns = 1000000000 + number * INT64_C(33333333);
  frame.color = fusebench::ColorImage(pinhole.width_px, pinhole.height_px);
  frame.depth_m = fusebench::DepthImage(pinhole.width_px, pinhole.height_px, 1.5F);
  for (int v = 0; v < pinhole.height_px; ++v) {
    for (int u = 0; u < pinhole.width_px; ++u) {
      const fusebench::Vector3d point = pinhole.back_project(u, v, 1.5);
      const double x = point.x() + x_m;
      const double grey =
          128 + 50 * std::sin(23 * x + 3 * std::sin(9 * point.y())) * std::cos(19 * point.y() - 2 * x) +
          40 * std::sin(41 * x) * std::sin(37 * point.y());
      frame.color(u, v).fill(static_cast<std::uint8_t>(grey));
    }
  }
  frame.grey = fusebench::to_grey(frame.color);
  return frame;
}

}  // namespace

int main() {
  const auto variant = fusebench::config::find_variant("no-imu");
  if (!variant) return 1;
  const fusebench::config::EffectiveConfig config = fusebench::config::variant_config(*variant);
  fusebench::SensorRig rig;
  rig.camera = camera();
  const fusebench::Workers workers(1);
  fusebench::core::RecordingEstimator pipeline(config.values(), rig, std::span<const fusebench::ImuSample>(),
                                               workers);
  for (int i = 0; i < 4; ++i) {
    const auto report = pipeline.process(frame_at(i, 0.005 * i));
    if (!report) {
      std::fprintf(stderr, "%s\n", report.error().message.c_str());
      return 1;
    }
    std::printf("%.*s x_mm %.0f\n", static_cast<int>(to_string(report->status).size()),
                to_string(report->status).data(), 1e3 * report->T_world_camera.translation.x());
  }
  return 0;
}
