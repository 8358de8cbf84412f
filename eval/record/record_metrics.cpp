#include "eval/record/record_metrics.hpp"

#include <array>
#include <limits>
#include <string>

#include "eval/metrics/mesh_error/mesh_json.hpp"
#include "eval/metrics/reference_clock/clock_json.hpp"
#include "eval/metrics/statistics_json.hpp"
#include "eval/metrics/trajectory_error/alignment_json.hpp"

namespace fusebench::record {

namespace {

using Json = nlohmann::ordered_json;

// NaN is dumped as null; null is read as NaN.
double number_at(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

metrics::Statistics statistics_of(const Json& json) {
  if (json.is_null()) return {};
  return {number_at(json, "rmse"),   number_at(json, "mean"),
          number_at(json, "median"), number_at(json, "std"),
          number_at(json, "min"),    number_at(json, "max"),
          number_at(json, "sse"),    json.at("count").get<std::size_t>()};
}

trajectory_error::Alignment alignment_of(const Json& json) {
  const auto m = json.at("matrix").get<std::array<double, 16>>();
  Matrix3d rotation;
  rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  return {json.at("mode"), {Quaterniond(rotation), {m[3], m[7], m[11]}}};
}

Json json_of(const trajectory_error::AteResult& ate) {
  return {{"protocol", ate.protocol},
          {"relation", ate.relation},
          {"unit", ate.unit},
          {"pairs", ate.pairs},
          {"possible", ate.possible},
          {"coverage", ate.coverage},
          {"max_difference_s", ate.max_difference_s},
          {"alignment", trajectory_error::json_of(ate.alignment)},
          {"stats", metrics::json_of(ate.stats)}};
}

void read(const Json& json, trajectory_error::AteResult& ate) {
  ate.protocol = json.at("protocol");
  ate.relation = json.at("relation");
  ate.unit = json.at("unit");
  ate.pairs = json.at("pairs");
  ate.possible = json.at("possible");
  ate.coverage = json.at("coverage");
  ate.max_difference_s = json.at("max_difference_s");
  ate.alignment = alignment_of(json.at("alignment"));
  ate.stats = statistics_of(json.at("stats"));
}

void read(const Json& json, trajectory_error::FittedOffset& fit) {
  fit.pairs = json.at("pairs");
  const auto offset_m = json.at("offset_m").get<std::array<double, 3>>();
  const auto sigma_m = json.at("offset_sigma_m").get<std::array<double, 3>>();
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    fit.offset_m[axis] = offset_m[at];
    fit.covariance_m2(axis, axis) = sigma_m[at] * sigma_m[at];
  }
  fit.T_reference_estimate = alignment_of(json.at("alignment")).T_reference_estimate;
  fit.stats = statistics_of(json.at("stats"));
}

Json json_of(const trajectory_error::RpeResult& rpe) {
  return {{"protocol", rpe.protocol},
          {"delta", rpe.delta},
          {"delta_unit", trajectory_error::to_string(rpe.unit)},
          {"pairs", rpe.pairs},
          {"possible", rpe.possible},
          {"coverage", rpe.coverage},
          {"max_difference_s", rpe.max_difference_s},
          {"alignment", trajectory_error::json_of(rpe.alignment)},
          {"translation", {{"unit", "m"}, {"stats", metrics::json_of(rpe.translation)}}},
          {"rotation", {{"unit", "rad"}, {"stats", metrics::json_of(rpe.rotation)}}}};
}

void read(const Json& json, trajectory_error::RpeResult& rpe) {
  rpe.protocol = json.at("protocol");
  rpe.delta = json.at("delta");
  rpe.unit = json.at("delta_unit") == trajectory_error::to_string(trajectory_error::DeltaUnit::frames)
                 ? trajectory_error::DeltaUnit::frames
                 : trajectory_error::DeltaUnit::seconds;
  rpe.pairs = json.at("pairs");
  rpe.possible = json.at("possible");
  rpe.coverage = json.at("coverage");
  rpe.max_difference_s = json.at("max_difference_s");
  rpe.alignment = alignment_of(json.at("alignment"));
  rpe.translation = statistics_of(json.at("translation").at("stats"));
  rpe.rotation = statistics_of(json.at("rotation").at("stats"));
}

Json json_of(const metrics::IntensitySummary& summary) {
  return {{"aie", summary.aie_grey},
          {"rms", summary.rms_grey},
          {"pixels", summary.pixels},
          {"frames", summary.frames},
          {"frames_excluded", summary.frames_excluded},
          {"stats", metrics::json_of(summary.stats)}};
}

metrics::IntensitySummary summary_of(const Json& json) {
  return {number_at(json, "aie"),
          number_at(json, "rms"),
          json.at("pixels").get<std::size_t>(),
          json.at("frames").get<std::size_t>(),
          json.at("frames_excluded").get<std::size_t>(),
          statistics_of(json.at("stats"))};
}

Json json_of(const metrics::IntensityResult& aie) {
  Json json = {{"protocol", "mean over frames of the mean over visible pixels of tracked patches"},
               {"unit", "grey levels 0-255"}};
  json.update(json_of(aie.all));
  json["accepted"] = json_of(aie.accepted);
  return json;
}

void read(const Json& json, metrics::IntensityResult& aie) {
  aie.all = summary_of(json);
  aie.accepted = summary_of(json.at("accepted"));
}

Json json_of(const metrics::IntensityReadings& readings) {
  Json grey = Json::object();
  for (const metrics::IntensityReading& reading : metrics::all_intensity_readings())
    grey[metrics::to_string(reading)] = readings.of(reading);
  return {{"protocol", "the intensity error by other definitions than AIE (docs/metrics.md)"},
          {"unit", "grey levels 0-255"},
          {"readings", grey}};
}

void read(const Json& json, metrics::IntensityReadings& readings) {
  const auto all = metrics::all_intensity_readings();
  for (std::size_t i = 0; i < all.size(); ++i)
    readings.grey[i] = number_at(json.at("readings"), metrics::to_string(all[i]).c_str());
}

Json json_of(const metrics::NeesResult& nees) {
  const metrics::NeesBounds bounds = metrics::nees_bounds_95(1, nees.part.dof);
  return {{"dof", nees.part.dof},        {"frames", nees.stats.count},
          {"possible", nees.possible},   {"mean", nees.stats.mean},
          {"median", nees.stats.median}, {"std", nees.stats.std},
          {"min", nees.stats.min},       {"max", nees.stats.max},
          {"final", nees.last},          {"final_bounds_95", {bounds.lower, bounds.upper}}};
}

void read(const Json& json, metrics::NeesResult& nees) {
  nees.possible = json.at("possible");
  nees.stats.count = json.at("frames");
  nees.stats.mean = number_at(json, "mean");
  nees.stats.median = number_at(json, "median");
  nees.stats.std = number_at(json, "std");
  nees.stats.min = number_at(json, "min");
  nees.stats.max = number_at(json, "max");
  nees.last = number_at(json, "final");
}

Json json_of(const metrics::ResidualSummary& summary) {
  return {{"protocol", "mean over tracked frames; chi2: mean squared whitened residual of a frame"},
          {"frames", summary.frames},
          {"chi2_photometric", summary.chi2_photometric},
          {"chi2_geometric", summary.chi2_geometric},
          {"patches_tracked", summary.patches_tracked},
          {"patches_accepted", summary.patches_accepted},
          {"accepted_share", summary.accepted_share}};
}

void read(const Json& json, metrics::ResidualSummary& summary) {
  summary.frames = json.at("frames");
  summary.chi2_photometric = number_at(json, "chi2_photometric");
  summary.chi2_geometric = number_at(json, "chi2_geometric");
  summary.patches_tracked = number_at(json, "patches_tracked");
  summary.patches_accepted = number_at(json, "patches_accepted");
  summary.accepted_share = number_at(json, "accepted_share");
}

Json json_of(const RecordedSilentFailures& silent) {
  const trajectory_error::SilentFailures& failures = silent.failures;
  return {{"protocol", "claimed poses whose motion over the interval before is off by more than a limit"},
          {"interval_s", failures.limits.interval_s},
          {"max_translation_m", failures.limits.max_translation_m},
          {"max_rotation_rad", failures.limits.max_rotation_rad},
          {"judged", failures.judged},
          {"silent", failures.silent},
          {"first_frame", silent.first_frame ? Json(*silent.first_frame) : Json(nullptr)},
          {"first_ns", failures.first_ns ? Json(*failures.first_ns) : Json(nullptr)},
          {"worst_translation_m", failures.worst_translation_m},
          {"worst_rotation_rad", failures.worst_rotation_rad}};
}

void read(const Json& json, RecordedSilentFailures& silent) {
  trajectory_error::SilentFailures& failures = silent.failures;
  failures.limits = {number_at(json, "interval_s"), number_at(json, "max_translation_m"),
                     number_at(json, "max_rotation_rad")};
  failures.judged = json.at("judged");
  failures.silent = json.at("silent");
  if (const Json& frame = json.at("first_frame"); !frame.is_null()) silent.first_frame = frame;
  if (const Json& stamp = json.at("first_ns"); !stamp.is_null()) failures.first_ns = stamp;
  failures.worst_translation_m = number_at(json, "worst_translation_m");
  failures.worst_rotation_rad = number_at(json, "worst_rotation_rad");
}

Json json_of(const RecordedPoseIntensity& intensity) {
  return {{"protocol", "the same probe patches for every system, moved by its poses; mean over frames"},
          {"aie_grey", intensity.aie_grey},
          {"rms_grey", intensity.rms_grey},
          {"frames", intensity.frames},
          {"pixels", intensity.pixels},
          {"visibility_by_truth", intensity.visibility_by_truth}};
}

void read(const Json& json, RecordedPoseIntensity& intensity) {
  intensity = {number_at(json, "aie_grey"), number_at(json, "rms_grey"), json.at("frames"), json.at("pixels"),
               json.at("visibility_by_truth")};
}

void read(const Json& json, reference_clock::ClockedErrors& errors) {
  const auto number = [&](const char* key, auto& value) {
    if (const Json& at = json.at(key); !at.is_null()) value = at;
  };
  number("ate_rmse_m", errors.ate_rmse_m);
  number("rpe_1s_m", errors.rpe_1s_m);
  number("rpe_1s_rad", errors.rpe_1s_rad);
  number("silent_failures", errors.silent);
}

void read(const Json& json, reference_clock::ReferenceClock& clock) {
  clock.offset = {number_at(json, "offset_s"), number_at(json, "sigma_s"), json.at("motions")};
  clock.applied = json.at("applied") == "fitted";
  read(json.at("as_read"), clock.as_read);
  read(json.at("fitted"), clock.fitted);
}

mesh_error::MeshDistances distances_of(const Json& json) {
  if (json.is_null()) return {};
  return {statistics_of(json), number_at(json, "p90"), number_at(json, "p95")};
}

mesh_error::MeshErrorResult mesh_error_of(const Json& json) {
  mesh_error::MeshErrorResult mesh;
  mesh.alignment = alignment_of(json.at("alignment"));
  mesh.accuracy = distances_of(json.at("accuracy"));
  mesh.completeness = distances_of(json.at("completeness"));
  mesh.chamfer_m = number_at(json, "chamfer_m");
  if (const auto ghosts = json.find("ghost_share"); ghosts != json.end() && ghosts->is_number())
    mesh.ghost_share = ghosts->get<double>();
  for (const Json& at : json.at("thresholds")) {
    mesh.thresholds.push_back({at.at("tau_m"), at.at("precision"), at.at("recall"), at.at("fscore")});
  }
  return mesh;
}

mesh_error::MeshSampling sampling_of(const Json& json) {
  const bool vertices = json.at("from") == mesh_error::to_string(mesh_error::MeshSamples::vertices);
  return {vertices ? mesh_error::MeshSamples::vertices : mesh_error::MeshSamples::area, json.at("count"),
          json.at("seed")};
}

Json json_of(const RecordedMesh& mesh) {
  const double observed = mesh.truth_samples == 0 ? 0.0
                                                  : static_cast<double>(mesh.truth_observed) /
                                                        static_cast<double>(mesh.truth_samples);
  Json json = {
      {"protocol",
       "exact distances to triangles; accuracy: reconstruction to truth; completeness: truth that "
       "the true pose of any tenth frame sees (frustum, range of depth, not occluded) to "
       "reconstruction; aligned by all poses of the trajectory, and beside it by the first true "
       "camera and by positions alone"},
      {"unit", "m"},
      {"samples",
       {{"reconstruction", mesh_error::json_of(mesh.reconstruction_sampling, mesh.reconstruction_samples)},
        {"truth", mesh_error::json_of(mesh.truth_sampling, mesh.truth_samples)}}},
      {"observed",
       {{"points", mesh.truth_observed},
        {"share", observed},
        {"views", mesh.views},
        {"min_depth_m", mesh.min_depth_m},
        {"max_depth_m", mesh.max_depth_m}}}};
  json.update(mesh_error::json_of(mesh.poses));
  json["first_camera"] = mesh_error::json_of(mesh.first_camera);
  json["positions"] = mesh.positions ? mesh_error::json_of(*mesh.positions) : Json(nullptr);
  return json;
}

void read(const Json& json, RecordedMesh& mesh) {
  const Json& samples = json.at("samples");
  mesh.reconstruction_sampling = sampling_of(samples.at("reconstruction"));
  mesh.truth_sampling = sampling_of(samples.at("truth"));
  mesh.reconstruction_samples = samples.at("reconstruction").at("points");
  mesh.truth_samples = samples.at("truth").at("points");
  const Json& observed = json.at("observed");
  mesh.truth_observed = observed.at("points");
  mesh.views = observed.at("views");
  mesh.min_depth_m = number_at(observed, "min_depth_m");
  mesh.max_depth_m = number_at(observed, "max_depth_m");
  mesh.poses = mesh_error_of(json);
  mesh.first_camera = mesh_error_of(json.at("first_camera"));
  if (const Json& positions = json.at("positions"); !positions.is_null()) {
    mesh.positions = mesh_error_of(positions);
  }
}

template <class T>
Json json_of(const Outcome<T>& outcome) {
  if (outcome.value) return json_of(*outcome.value);
  return {{"stats", nullptr}, {"reason", outcome.reason}};
}

template <class T>
Outcome<T> outcome_of(const Json& json) {
  if (json.contains("reason")) return {std::nullopt, json.at("reason")};
  Outcome<T> outcome{T{}, {}};
  read(json, *outcome.value);
  return outcome;
}

// The reason of what a record of an earlier version does not have.
constexpr const char* kOlderRecord = "the record is older than this metric";

template <class T>
Outcome<T> newer_outcome_of(const Json& json, const std::string& key) {
  if (!json.contains(key)) return {std::nullopt, kOlderRecord};
  return outcome_of<T>(json.at(key));
}

Json json_of_nees(const RecordedNees& nees) {
  Json json = {{"protocol",
                "(truth - estimate)^T P^-1 (truth - estimate) / dof, of tracked frames after the first; the "
                "truth is moved by the first camera's true pose; 1 is consistent"}};
  for (std::size_t i = 0; i < nees.size(); ++i) {
    json[std::string(metrics::kStateParts[i].name)] = json_of(nees[i]);
  }
  return json;
}

RecordedNees nees_of(const Json& metrics) {
  RecordedNees nees;
  const Json json = metrics.value("nees", Json::object());
  for (std::size_t i = 0; i < nees.size(); ++i) {
    nees[i] = newer_outcome_of<metrics::NeesResult>(json, std::string(metrics::kStateParts[i].name));
    if (nees[i].value) nees[i].value->part = metrics::kStateParts[i];
  }
  return nees;
}

}  // namespace

Json json_of_metrics(const RecordedMetrics& metrics, const RecordedFrames& frames) {
  return {{"ate", json_of(metrics.ate)},
          {"ate_fitted_offset", json_of(metrics.ate_fitted)},
          {"rpe", {{"frame", json_of(metrics.rpe_frame)}, {"second", json_of(metrics.rpe_second)}}},
          {"aie", json_of(metrics.aie)},
          {"intensity_readings", json_of(metrics.intensity_readings)},
          {"mesh", json_of(metrics.mesh)},
          {"nees", json_of_nees(metrics.nees)},
          {"residuals", json_of(metrics.residuals)},
          {"silent_failures", json_of(metrics.silent)},
          {"pose_intensity", json_of(metrics.pose_intensity)},
          {"reference_clock", json_of(metrics.reference_clock)},
          {"coverage",
           {{"protocol", "tracked frames / frames of the recording"},
            {"tracked", frames.tracked},
            {"total", frames.total},
            {"share", coverage_share(frames)}}}};
}

void read_metrics(const Json& json, RecordedMetrics& metrics) {
  metrics.ate = outcome_of<trajectory_error::AteResult>(json.at("ate"));
  metrics.ate_fitted = newer_outcome_of<trajectory_error::FittedOffset>(json, "ate_fitted_offset");
  metrics.rpe_frame = outcome_of<trajectory_error::RpeResult>(json.at("rpe").at("frame"));
  metrics.rpe_second = outcome_of<trajectory_error::RpeResult>(json.at("rpe").at("second"));
  metrics.aie = outcome_of<metrics::IntensityResult>(json.at("aie"));
  metrics.intensity_readings = newer_outcome_of<metrics::IntensityReadings>(json, "intensity_readings");
  metrics.mesh = newer_outcome_of<RecordedMesh>(json, "mesh");
  metrics.nees = nees_of(json);
  metrics.residuals = newer_outcome_of<metrics::ResidualSummary>(json, "residuals");
  metrics.silent = newer_outcome_of<RecordedSilentFailures>(json, "silent_failures");
  metrics.pose_intensity = newer_outcome_of<RecordedPoseIntensity>(json, "pose_intensity");
  metrics.reference_clock = newer_outcome_of<reference_clock::ReferenceClock>(json, "reference_clock");
}

}  // namespace fusebench::record
