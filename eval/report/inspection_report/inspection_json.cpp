#include "eval/report/inspection_report/inspection_json.hpp"

#include <nlohmann/json.hpp>

#include "eval/report/inspection_report/depth_camera_report.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::inspection_report {

namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json json_of(const std::optional<Value>& value) {
  if (!value) return nullptr;
  return *value;
}

Json json_of(const std::optional<Vector3d>& v) {
  if (!v) return nullptr;
  return {v->x(), v->y(), v->z()};
}

Json json_of(const Matrix3d& m) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) rows.push_back({m(row, 0), m(row, 1), m(row, 2)});
  return rows;
}

Json json_of(const inspection::StampMeasurement& s) {
  return {
      {"count", s.count},
      {"duration_s", s.duration_s},
      {"rate_hz", s.rate_hz},
      {"interval_s", {{"median", s.median_interval_s}, {"min", s.min_interval_s}, {"max", s.max_interval_s}}},
      {"jitter_rms_s", s.jitter_rms_s},
      {"duplicates", s.duplicates},
      {"backwards", s.backwards},
      {"gaps", s.gaps},
      {"missing", s.missing}};
}

Json json_of(const std::vector<inspection::Finding>& findings) {
  Json list = Json::array();
  for (const inspection::Finding& f : findings)
    list.push_back({{"code", f.code},
                    {"severity", inspection::to_string(f.severity)},
                    {"message", f.message},
                    {"hint", f.hint}});
  return list;
}

Json json_of(const inspection::ExposureMeasurement& e) {
  return {{"mean_grey", e.mean_grey},
          {"saturated_share", e.saturated_share},
          {"dark_share", e.dark_share},
          {"drift_grey", e.drift_grey},
          {"sharpness", {{"median", e.sharpness_median}, {"p05", e.sharpness_p05}}}};
}

Json json_of(const inspection::DepthMeasurement& d) {
  return {{"coverage", {{"median", d.coverage_median}, {"min", d.coverage_min}}},
          {"median_m", d.median_m},
          {"min_m", d.min_m},
          {"max_m", d.max_m},
          {"beyond_10m_share", d.beyond_10m_share},
          {"below_quarter_metre_share", d.below_quarter_metre_share},
          {"histogram", {{"bin_m", inspection::kDepthBin_m}, {"counts", d.histogram}}}};
}

Json json_of(const inspection::MotionMeasurement& m) {
  if (m.source.empty()) return nullptr;
  return {
      {"source", m.source},
      {"class", m.fast ? "fast" : "slow"},
      {"angular_radps",
       {{"mean", m.angular_mean_radps}, {"p95", m.angular_p95_radps}, {"max", m.angular_max_radps}}},
      {"linear_mps",
       {{"mean", json_of(m.linear_mean_mps)},
        {"p95", json_of(m.linear_p95_mps)},
        {"max", json_of(m.linear_max_mps)}}},
      {"blur_px",
       {{"exposure_s", inspection::kBlurExposure_s}, {"median", m.blur_median_px}, {"p95", m.blur_p95_px}}},
      {"severe_blur",
       {{"threshold_px", inspection::kSevereBlur_px},
        {"share", m.severe_share},
        {"fast_from_share", inspection::kFastShare}}}};
}

Json json_of(const inspection::ImuMeasurement& m) {
  return {{"stamps", json_of(m.stamps)},
          {"coverage", m.coverage},
          {"gyroscope_max_radps", m.gyroscope_max_radps},
          {"accelerometer_max_mps2", m.accelerometer_max_mps2},
          {"specific_force_median_mps2", m.specific_force_median_mps2},
          {"longest_repeat", m.longest_repeat},
          {"gravity_mps2", json_of(m.gravity_mps2)},
          {"gravity_source", m.gravity_source},
          {"gyroscope_bias_radps", json_of(m.gyroscope_bias_radps)},
          {"gyroscope_bias_source", m.bias_source},
          {"accelerometer_bias_mps2", json_of(m.accelerometer_bias_mps2)}};
}

Json json_of(const inspection::ImuAlignment& a) {
  return {{"source", a.source},
          {"intervals", a.intervals},
          {"time_offset_s", {{"value", a.time_offset_s}, {"sigma", a.time_offset_sigma_s}}},
          {"rotation_imu_camera", json_of(a.rotation_imu_camera)},
          {"rotation_error_rad", {{"value", json_of(a.rotation_error_rad)}, {"sigma", a.rotation_sigma_rad}}},
          {"gyroscope_scale", a.scale},
          {"residual_radps", a.residual_radps},
          {"explained", a.explained}};
}

Json json_of(const inspection::ReprojectionMeasurement& r) {
  Json pairs = Json::array();
  for (const inspection::ReprojectionPair& p : r.pairs) {
    pairs.push_back({{"from", p.from},
                     {"to", p.to},
                     {"rotation_rad", p.rotation_rad},
                     {"translation_m", p.translation_m},
                     {"depth_residual_m", p.depth_residual_m},
                     {"depth_residual_share", p.depth_residual_share},
                     {"intensity_residual_grey", p.intensity_residual_grey},
                     {"overlap", p.overlap}});
  }
  Json hypotheses = Json::array();
  for (const inspection::HypothesisResult& h : r.hypotheses) {
    hypotheses.push_back({{"code", h.code},
                          {"name", h.name},
                          {"value", h.value},
                          {"residual_factor", h.factor},
                          {"wins", h.wins}});
  }
  return {{"depth_residual_m", r.depth_residual_m},
          {"depth_residual_share", r.depth_residual_share},
          {"intensity_residual_grey", r.intensity_residual_grey},
          {"no_motion_factor", r.static_factor},
          {"pairs", pairs},
          {"hypotheses", hypotheses}};
}

}  // namespace

std::string to_json(const inspection::Inspection& i) {
  Json document = {{"recording", i.recording},
                   {"format", i.format},
                   {"fingerprint", i.fingerprint},
                   {"frames", i.frames},
                   {"imu", recording::to_string(i.imu_source)},
                   {"findings", json_of(i.findings)}};
  if (i.frames > 0) {
    document["sampled_frames"] = i.images.size();
    document["stamps"] = {{"color", json_of(i.color_stamps)}, {"depth", json_of(i.depth_stamps)}};
    document["association"] = {{"median_s", i.association.median_s},
                               {"max_s", i.association.max_s},
                               {"reused_depth", i.association.reused},
                               {"repeated_color", i.association.repeats},
                               {"repeated_depth", i.association.frozen}};
    document["exposure"] = json_of(i.exposure);
    document["depth"] = json_of(i.depth);
    document["registration"] = nullptr;
    if (i.registration) {
      const inspection::measures::RegistrationFit& fit = *i.registration;
      document["registration"] = registration_json(fit);
      document["registration"]["depth_camera"] = camera_json(fit.fitted);
    }
    document["motion"] = json_of(i.motion);
    document["truth"] = nullptr;
    if (i.truth) {
      document["truth"] = {
          {"stamps", json_of(i.truth->stamps)}, {"coverage", i.truth->coverage}, {"path_m", i.truth->path_m}};
    }
    document["imu_values"] = i.imu ? json_of(*i.imu) : Json(nullptr);
    document["imu_alignment"] = i.imu_alignment ? json_of(*i.imu_alignment) : Json(nullptr);
    document["reprojection"] = i.reprojection ? json_of(*i.reprojection) : Json(nullptr);
  }
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::inspection_report
