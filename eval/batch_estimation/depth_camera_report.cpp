#include "eval/batch_estimation/depth_camera_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "eval/text/json_text.hpp"

namespace fusebench::batch_estimation {

namespace {

using Json = nlohmann::ordered_json;

std::string camera_text(const calibration::DepthCamera& camera) {
  return fmt::format("{:.1f} x {:.1f} px, centre ({:.1f}, {:.1f}) px, at ({:.1f}, {:.1f}) mm of colour",
                     camera.pinhole.fx_px, camera.pinhole.fy_px, camera.pinhole.cx_px, camera.pinhole.cy_px,
                     1e3 * camera.T_color_depth.translation.x(), 1e3 * camera.T_color_depth.translation.y());
}

Json camera_json(const calibration::DepthCamera& camera) {
  return {{"fx_px", camera.pinhole.fx_px},
          {"fy_px", camera.pinhole.fy_px},
          {"cx_px", camera.pinhole.cx_px},
          {"cy_px", camera.pinhole.cy_px},
          {"x_m", camera.T_color_depth.translation.x()},
          {"y_m", camera.T_color_depth.translation.y()}};
}

}  // namespace

Result<DepthCameraEstimate> estimate_depth_camera(const recording::Recording& recording,
                                                  const Workers& workers) {
  const auto fit = inspection::measures::fit_registration(recording, workers);
  if (!fit) {
    return fail(
        ErrorCode::run_failed,
        fmt::format("recording '{}' has too few edges of depth to estimate a depth camera", recording.name),
        "record things that stand apart from what is behind them, near and far, all over the image");
  }
  DepthCameraEstimate out{*fit, {recording.rig.camera, SE3{}}, {}};
  if (recording.calibration && recording.calibration->depth) out.as_read = *recording.calibration->depth;
  out.fitted = inspection::measures::fitted_depth_camera(fit->model, recording);
  return out;
}

calibration::RigCalibration rig_with_depth_camera(const recording::Recording& recording,
                                                  const DepthCameraEstimate& estimate) {
  check(recording.calibration.has_value(), "the recording's reader kept its calibration");
  calibration::RigCalibration rig = *recording.calibration;
  rig.depth = estimate.fitted;
  rig.source = fmt::format(
      "depth camera by fusebench calibrate on {} edges of {} (uncertain by {:.1f} px); the rest: {}",
      estimate.fit.edges, recording.name, estimate.fit.spread_px,
      rig.source.empty() ? "no source given" : rig.source);
  return rig;
}

std::string to_text(const DepthCameraEstimate& estimate, const recording::Recording& recording) {
  const inspection::measures::RegistrationFit& fit = estimate.fit;
  return fmt::format(
      "depth camera of {} by {} edges of depth\n"
      "  as read        {}\n"
      "  fitted         {}\n"
      "  edges move     {:.1f} px (rms), and by {:.1f} px between the fits to every other frame\n"
      "  better         {:.0f} % of the frames; strength of colour's edges there {:.3f} -> {:.3f}\n",
      recording.name, fit.edges, camera_text(estimate.as_read), camera_text(estimate.fitted), fit.moved_px,
      fit.spread_px, 100 * fit.better_share, fit.strength_as_read, fit.strength_moved);
}

std::string to_json(const DepthCameraEstimate& estimate, const recording::Recording& recording) {
  const inspection::measures::RegistrationFit& fit = estimate.fit;
  const Json document{{"recording", recording.name},
                      {"recording_fingerprint", recording.fingerprint},
                      {"edge_pixels", fit.edges},
                      {"as_read", camera_json(estimate.as_read)},
                      {"fitted", camera_json(estimate.fitted)},
                      {"moved_px", fit.moved_px},
                      {"spread_px", fit.spread_px},
                      {"better_share", fit.better_share},
                      {"strength_as_read", fit.strength_as_read},
                      {"strength_moved", fit.strength_moved}};
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::batch_estimation
