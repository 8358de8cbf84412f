#include "eval/run/preparation/depth_camera.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "datasets/calibration/depth_registration.hpp"
#include "eval/run/preparation/preparation.hpp"

namespace fusebench::preparation {

namespace {

using Json = nlohmann::ordered_json;
namespace measures = inspection::measures;

Json camera_json(const calibration::DepthCamera& camera) {
  const PinholeCamera& p = camera.pinhole;
  const Vector3d& place_m = camera.T_color_depth.translation;
  const Quaterniond& q = camera.T_color_depth.rotation;
  return {{"size_px", {p.width_px, p.height_px}},
          {"focal_length_px", {p.fx_px, p.fy_px}},
          {"centre_px", {p.cx_px, p.cy_px}},
          {"place_m", {place_m.x(), place_m.y(), place_m.z()}},
          {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

calibration::DepthCamera camera_of(const Json& json) {
  const auto at = [&](const char* key, std::size_t i) { return json.at(key).at(i).get<double>(); };
  calibration::DepthCamera camera;
  camera.pinhole = {json.at("size_px").at(0), json.at("size_px").at(1), at("focal_length_px", 0),
                    at("focal_length_px", 1), at("centre_px", 0),       at("centre_px", 1)};
  camera.T_color_depth.translation = {at("place_m", 0), at("place_m", 1), at("place_m", 2)};
  camera.T_color_depth.rotation = Quaterniond(at("rotation_xyzw", 3), at("rotation_xyzw", 0),
                                              at("rotation_xyzw", 1), at("rotation_xyzw", 2));
  return camera;
}

std::string values_text(const MeasuredDepthCamera& measured) {
  const PinholeCamera& p = measured.fitted.pinhole;
  const Vector3d& place_m = measured.fitted.T_color_depth.translation;
  const measures::DepthCameraSigma& sigma = measured.sigma;
  return fmt::format(
      "focal length {:.1f} +- {:.1f} px, centre ({:.1f} +- {:.1f}, {:.1f} +- {:.1f}) px, at ({:.1f} +- "
      "{:.1f}, "
      "{:.1f} +- {:.1f}) mm of colour",
      p.fx_px, sigma.focal_length_px, p.cx_px, sigma.centre_px.x(), p.cy_px, sigma.centre_px.y(),
      1e3 * place_m.x(), 1e3 * sigma.place_m.x(), 1e3 * place_m.y(), 1e3 * sigma.place_m.y());
}

}  // namespace

MeasuredDepthCamera measured_depth_camera(const measures::RegistrationFit& fit) {
  return {fit.as_read, fit.fitted, fit.fitted_sigma, fit.moved_px, fit.sigma_px, fit.is_determined()};
}

std::string to_line(const MeasuredDepthCamera& measured) {
  return fmt::format("depth camera: {}; edges of depth move {:.1f} +- {:.1f} px; {}", values_text(measured),
                     measured.moved_px, measured.sigma_px,
                     measured.is_used ? "used in place of the calibration's"
                                      : "the calibration's is kept: it is not contradicted");
}

nlohmann::ordered_json json_of(const MeasuredDepthCamera& measured) {
  const measures::DepthCameraSigma& sigma = measured.sigma;
  return {{"as_read", camera_json(measured.as_read)},
          {"fitted", camera_json(measured.fitted)},
          {"focal_length_sigma_px", sigma.focal_length_px},
          {"centre_sigma_px", {sigma.centre_px.x(), sigma.centre_px.y()}},
          {"place_sigma_m", {sigma.place_m.x(), sigma.place_m.y()}},
          {"moved_px", measured.moved_px},
          {"sigma_px", measured.sigma_px},
          {"used", measured.is_used}};
}

MeasuredDepthCamera depth_camera_of(const Json& json) {
  const auto pair = [&](const char* key) {
    return Vector2d(json.at(key).at(0).get<double>(), json.at(key).at(1).get<double>());
  };
  MeasuredDepthCamera measured;
  measured.as_read = camera_of(json.at("as_read"));
  measured.fitted = camera_of(json.at("fitted"));
  measured.sigma.focal_length_px = json.at("focal_length_sigma_px");
  measured.sigma.centre_px = pair("centre_sigma_px");
  measured.sigma.place_m = pair("place_sigma_m");
  measured.moved_px = json.at("moved_px");
  measured.sigma_px = json.at("sigma_px");
  measured.is_used = json.at("used");
  return measured;
}

void use_depth_camera(recording::Recording& recording, const MeasuredDepthCamera& measured) {
  if (!measured.is_used) return;
  const PinholeCamera& color = recording.rig.camera;
  // Loaded depth lies in the colour camera: the difference of the two depth cameras is applied to it.
  const calibration::DepthCamera between = measures::fitted_depth_camera(
      measures::model_between(measured.as_read, measured.fitted, color), color, {color, SE3{}});
  const calibration::DepthRegistration registration(between.pinhole, color, between.T_color_depth);
  recording.load_frame = [registration, load = recording.load_frame](std::size_t k) {
    auto frame = load(k);
    if (frame) frame->depth_m = registration.register_depth(frame->depth_m);
    return frame;
  };
  if (recording.calibration) recording.calibration->depth = measured.fitted;
  recording.notes.push_back(fmt::format("{}{}", kPreparedNote, to_line(measured)));
}

}  // namespace fusebench::preparation
