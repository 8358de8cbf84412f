#include "eval/record/record_camera.hpp"

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

}  // namespace fusebench::record
