#include "eval/report/inspection_report/depth_camera_report.hpp"

#include <fmt/format.h>

#include <string_view>

#include "eval/text/json_text.hpp"

namespace fusebench::inspection_report {

namespace {

using inspection::measures::RegistrationFit;
using Json = nlohmann::ordered_json;

std::string camera_text(const calibration::DepthCamera& camera) {
  return fmt::format("{:.1f} x {:.1f} px, centre ({:.1f}, {:.1f}) px, at ({:.1f}, {:.1f}) mm of colour",
                     camera.pinhole.fx_px, camera.pinhole.fy_px, camera.pinhole.cx_px, camera.pinhole.cy_px,
                     1e3 * camera.T_color_depth.translation.x(), 1e3 * camera.T_color_depth.translation.y());
}

}  // namespace

Json camera_json(const calibration::DepthCamera& camera) {
  return {{"fx_px", camera.pinhole.fx_px},
          {"fy_px", camera.pinhole.fy_px},
          {"cx_px", camera.pinhole.cx_px},
          {"cy_px", camera.pinhole.cy_px},
          {"x_m", camera.T_color_depth.translation.x()},
          {"y_m", camera.T_color_depth.translation.y()}};
}

Json registration_json(const RegistrationFit& fit) {
  return {{"edge_pixels", fit.edges},
          {"moved_px", fit.moved_px},
          {"sigma_px", fit.sigma_px},
          {"delay_frames", fit.delay_frames},
          {"gain_sigmas", fit.gain_sigmas},
          {"strength_as_read", fit.strength_as_read},
          {"strength_moved", fit.strength_moved}};
}

Result<RegistrationFit> estimate_depth_camera(const recording::Recording& recording, const Workers& workers) {
  if (auto fit = inspection::measures::fit_registration(recording, workers)) return *fit;
  return fail(
      ErrorCode::run_failed,
      fmt::format("recording '{}' has too few edges of depth to estimate a depth camera", recording.name),
      "record objects in front of a more distant background, near and far, in all parts of the image");
}

Result<void> check_determined(const RegistrationFit& fit, const recording::Recording& recording) {
  if (fit.is_determined()) return {};
  const std::string reason =
      !fit.is_significant()
          ? fmt::format(
                "edges move {:.1f} +- {:.1f} px (allowed: {:g} standard deviations or more, with {:g} px "
                "that "
                "the scatter of frames does not show)",
                fit.moved_px, fit.sigma_px, RegistrationFit::kSignificant, RegistrationFit::kCommonSigma_px)
          : fmt::format(
                "edges move {:.1f} px and gain only {:.1f} standard deviations of edge strength (required: "
                "{:g} or more)",
                fit.moved_px, fit.gain_sigmas, RegistrationFit::kMinGainSigmas);
  return fail(
      ErrorCode::run_failed,
      fmt::format("recording '{}' does not determine a depth camera: {}", recording.name, reason),
      "if `inspect` does not warn of depth-misregistered, the calibration is right as it is; else record "
      "things near and far, all over the image, with a camera that moves slowly");
}

calibration::RigCalibration rig_with_depth_camera(const recording::Recording& recording,
                                                  const RegistrationFit& fit) {
  check(recording.calibration.has_value(), "the recording's reader kept its calibration");
  calibration::RigCalibration rig = *recording.calibration;
  rig.depth = fit.fitted;
  rig.source = fmt::format(
      "depth camera by fusebench calibrate on {} edges of {} (uncertain by {:.1f} px); the rest: {}",
      fit.edges, recording.name, fit.sigma_px, rig.source.empty() ? "no source given" : rig.source);
  return rig;
}

std::string depth_camera_text(const RegistrationFit& fit, const recording::Recording& recording) {
  const std::string_view verdict = check_determined(fit, recording)
                                       ? "the depth camera is determined"
                                       : "not determined: no better than depth as read";
  return fmt::format(
      "depth camera of {} by {} edges of depth\n"
      "  as read        {}\n"
      "  fitted         {}\n"
      "  uncertainty    {:.1f} px, centre ({:.1f}, {:.1f}) px, ({:.1f}, {:.1f}) mm\n"
      "  edges move     {:.1f} +- {:.1f} px (rms)\n"
      "  strength       of colour's edges there {:.3f} -> {:.3f}: a gain of {:.1f} standard deviations\n"
      "  verdict        {}\n",
      recording.name, fit.edges, camera_text(fit.as_read), camera_text(fit.fitted),
      fit.fitted_sigma.focal_length_px, fit.fitted_sigma.centre_px.x(), fit.fitted_sigma.centre_px.y(),
      1e3 * fit.fitted_sigma.place_m.x(), 1e3 * fit.fitted_sigma.place_m.y(), fit.moved_px, fit.sigma_px,
      fit.strength_as_read, fit.strength_moved, fit.gain_sigmas, verdict);
}

std::string depth_camera_json(const RegistrationFit& fit, const recording::Recording& recording) {
  Json document{{"recording", recording.name},
                {"recording_fingerprint", recording.fingerprint},
                {"as_read", camera_json(fit.as_read)},
                {"fitted", camera_json(fit.fitted)}};
  document.update(registration_json(fit));
  document["determined"] = check_determined(fit, recording).has_value();
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::inspection_report
