#include "eval/record/record_parts.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::record {

namespace {

using Json = nlohmann::ordered_json;

using calibration::kMostDelay_s;
using calibration::kMostReadout_s;

double number_in(const Json& table, const std::string& key, double least, double most) {
  const double value = table.at(key);
  if (value >= least && value <= most) return value;
  throw std::invalid_argument(
      fmt::format("{} of the camera = {} (allowed: {} to {})", key, value, least, most));
}

double positive(const Json& table, const std::string& key) {
  const double value = table.at(key);
  if (value > 0) return value;
  throw std::invalid_argument(fmt::format("{} of the camera = {} (allowed: above 0)", key, value));
}

int size_of(const Json& table, const std::string& key) {
  return static_cast<int>(number_in(table, key, 1, calibration::kMostSize_px));
}

PinholeCamera pinhole_of(const Json& color) {
  return {size_of(color, "width_px"), size_of(color, "height_px"), positive(color, "fx_px"),
          positive(color, "fy_px"),   color.at("cx_px"),           color.at("cy_px")};
}

SensorTiming timing_of(const Json& color, const Json& depth) {
  return {number_in(color, "readout_s", 0, kMostReadout_s),
          number_in(depth, "readout_s", 0, kMostReadout_s),
          number_in(depth, "delay_s", -kMostDelay_s, kMostDelay_s),
          number_in(color, "readout_sigma_s", 0, kMostReadout_s),
          number_in(depth, "readout_sigma_s", 0, kMostReadout_s),
          number_in(depth, "delay_sigma_s", 0, kMostDelay_s)};
}

Vector3d offset_of(const Json& offset_m) {
  const Vector3d offset(offset_m.at(0), offset_m.at(1), offset_m.at(2));
  if (offset.cwiseAbs().maxCoeff() <= calibration::kMostLeverArm_m) return offset;
  throw std::invalid_argument(fmt::format("ground_truth_offset_m of the camera has a component above {} m",
                                          calibration::kMostLeverArm_m));
}

Json json_of(const loop_error::Revisits& revisits) {
  return {{"count", revisits.count}, {"found", revisits.found}};
}

loop_error::Revisits revisits_of(const Json& json) { return {json.at("count"), json.at("found")}; }

}  // namespace

Json json_of_camera(const RecordedCamera& camera) {
  const PinholeCamera& pinhole = camera.color.pinhole;
  const calibration::BrownConrady& d = camera.color.distortion;
  const SensorTiming& timing = camera.color.timing;
  const Vector3d& offset_m = camera.color.ground_truth_offset_m;
  const auto& units = camera.depth_units_per_metre;
  return {{"color",
           {{"width_px", pinhole.width_px},
            {"height_px", pinhole.height_px},
            {"fx_px", pinhole.fx_px},
            {"fy_px", pinhole.fy_px},
            {"cx_px", pinhole.cx_px},
            {"cy_px", pinhole.cy_px},
            {"distortion", Json::array({d.k1, d.k2, d.p1, d.p2, d.k3})},
            {"readout_s", timing.color_readout_s},
            {"readout_sigma_s", timing.color_readout_sigma_s},
            {"ground_truth_offset_m", Json::array({offset_m.x(), offset_m.y(), offset_m.z()})}}},
          {"depth",
           {{"units_per_metre", units ? Json(*units) : Json(nullptr)},
            {"readout_s", timing.depth_readout_s},
            {"readout_sigma_s", timing.depth_readout_sigma_s},
            {"delay_s", timing.depth_delay_s},
            {"delay_sigma_s", timing.depth_delay_sigma_s}}}};
}

RecordedCamera camera_of(const Json& json) {
  const Json& color = json.at("color");
  const Json& depth = json.at("depth");
  const Json& k = color.at("distortion");
  RecordedCamera camera;
  camera.color = {pinhole_of(color),
                  {k.at(0), k.at(1), k.at(2), k.at(3), k.at(4)},
                  timing_of(color, depth),
                  offset_of(color.at("ground_truth_offset_m"))};
  if (!depth.at("units_per_metre").is_null())
    camera.depth_units_per_metre = positive(depth, "units_per_metre");
  return camera;
}

Json json_of_loops(const Outcome<loop_error::LoopError>& loops) {
  if (!loops.value) return {{"error", nullptr}, {"reason", loops.reason}};
  const loop_error::LoopError& error = *loops.value;
  const auto of_accepted = [&](double value) { return error.accepted > 0 ? Json(value) : Json(nullptr); };
  const Json protocol = {{"revisit_overlap", loop_error::kRevisitOverlap},
                         {"blurred_px", loop_error::kBlurred_px},
                         {"false_translation_m", loop_error::kFalseTranslation_m},
                         {"false_rotation_rad", loop_error::kFalseRotation_rad},
                         {"false_sigmas", loop_error::kFalseSigmas}};
  return {{"error",
           {{"protocol", protocol},
            {"places", error.places},
            {"revisits", {{"sharp", json_of(error.sharp)}, {"blurred", json_of(error.blurred)}}},
            {"verified", error.verified},
            {"accepted", error.accepted},
            {"false_verified", error.false_verified},
            {"false_accepted", error.false_accepted},
            {"median_translation_m", of_accepted(error.median_translation_m)},
            {"median_rotation_rad", of_accepted(error.median_rotation_rad)},
            {"nees_rotation", of_accepted(error.nees_rotation)},
            {"nees_position", of_accepted(error.nees_position)},
            {"oracle_ate_m", error.oracle_ate_m ? Json(*error.oracle_ate_m) : Json(nullptr)}}},
          {"reason", nullptr}};
}

Outcome<loop_error::LoopError> loops_of(const Json& json) {
  const Json& values = json.at("error");
  if (values.is_null()) return {std::nullopt, json.at("reason")};
  loop_error::LoopError error;
  error.places = values.at("places");
  error.sharp = revisits_of(values.at("revisits").at("sharp"));
  error.blurred = revisits_of(values.at("revisits").at("blurred"));
  error.verified = values.at("verified");
  error.accepted = values.at("accepted");
  error.false_verified = values.at("false_verified");
  error.false_accepted = values.at("false_accepted");
  if (error.accepted > 0) {
    error.median_translation_m = values.at("median_translation_m");
    error.median_rotation_rad = values.at("median_rotation_rad");
    error.nees_rotation = values.at("nees_rotation");
    error.nees_position = values.at("nees_position");
  }
  if (const Json& ate = values.at("oracle_ate_m"); !ate.is_null()) error.oracle_ate_m = ate;
  return {error, {}};
}

}  // namespace fusebench::record
