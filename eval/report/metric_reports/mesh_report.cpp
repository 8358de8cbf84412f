#include "eval/report/metric_reports/mesh_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/geometry.hpp"
#include "eval/metrics/mesh_error/mesh_json.hpp"
#include "eval/metrics/trajectory_error/alignment_json.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::metric_reports {

namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::vector<std::string>>;

std::string shape_text(const std::string& file, const mesh_error::MeshShape& shape) {
  const std::string parts =
      shape.surfels ? fmt::format("{} surfels", shape.vertices)
                    : fmt::format("{} vertices{}, {} triangles", shape.vertices,
                                  shape.unused_vertices == 0
                                      ? ""
                                      : fmt::format(" (and {} of no triangle)", shape.unused_vertices),
                                  shape.triangles);
  return fmt::format("{}: {}, {:.4g} x {:.4g} x {:.4g} m", file, parts, shape.extent_m.x(),
                     shape.extent_m.y(), shape.extent_m.z());
}

std::string alignment_text(const mesh_error::MeshEvaluation& e, const mesh_error::MeshRequest& request) {
  const trajectory_error::Alignment& alignment = e.errors.alignment;
  if (alignment.mode == "none") return "none: both are assumed to be in one frame";
  const SE3& T = alignment.T_reference_estimate;
  std::string text = fmt::format("{}: rotated by {:.4f} deg, translated by ({:.4f}, {:.4f}, {:.4f}) m",
                                 alignment.mode, degrees(so3_log(T.rotation).norm()), T.translation.x(),
                                 T.translation.y(), T.translation.z());
  if (!e.icp) return text;
  text += fmt::format(" ({} steps{} from {}, the nearest {:.0f} % of points used, {:.4g} m rms)",
                      e.icp->steps, e.icp->converged ? "" : ", not converged,",
                      request.start.mode == "none" ? "its own pose" : "the " + request.start.mode,
                      100 * request.icp->kept, e.icp->kept_rms_m);
  if (e.icp->free_directions > 0)
    text += fmt::format("; {} of 6 directions are not observable and stay unchanged", e.icp->free_directions);
  return text;
}

std::string samples_text(const mesh_error::MeshSampling& sampling, std::size_t count) {
  if (sampling.from == mesh_error::MeshSamples::vertices) return fmt::format("{} vertices", count);
  return fmt::format("{} even over the area (seed {})", count, sampling.seed);
}

double observed_share(const mesh_error::MeshEvaluation& e) {
  return static_cast<double>(e.truth_observed) / static_cast<double>(e.truth_samples);
}

std::string culling_text(const mesh_error::MeshEvaluation& e, const mesh_error::MeshRequest& request,
                         const ComparedMeshes& files) {
  if (!request.views) return "none: the whole ground truth counts";
  return fmt::format("{} of {} views of {}, {:.3g} to {:.3g} m: {:.1f} % of the ground truth is observed",
                     mesh_error::to_string(request.views->culling), request.views->T_truth_camera.size(),
                     files.recording, request.views->min_depth_m, request.views->max_depth_m,
                     100 * observed_share(e));
}

/// A column for each direction.
std::string statistics_text(const mesh_error::MeshEvaluation& e) {
  std::vector<std::pair<std::string, const mesh_error::MeshDistances*>> columns = {
      {"accuracy [m]", &e.errors.accuracy}, {"completeness [m]", &e.errors.completeness}};
  if (e.not_culled) columns.emplace_back("of the whole ground truth [m]", &e.not_culled->completeness);
  Lines lines = {{""}};
  for (const auto& [title, distances] : columns) lines[0].push_back(title);
  const auto add = [&](const char* name, auto&& value) {
    lines.push_back({name});
    for (const auto& [title, distances] : columns)
      lines.back().push_back(text::seven_digits(value(*distances)));
  };
  add("mean", [](const mesh_error::MeshDistances& d) { return d.stats.mean; });
  add("rmse", [](const mesh_error::MeshDistances& d) { return d.stats.rmse; });
  add("median", [](const mesh_error::MeshDistances& d) { return d.stats.median; });
  add("std", [](const mesh_error::MeshDistances& d) { return d.stats.std; });
  add("p90", [](const mesh_error::MeshDistances& d) { return d.p90; });
  add("p95", [](const mesh_error::MeshDistances& d) { return d.p95; });
  add("max", [](const mesh_error::MeshDistances& d) { return d.stats.max; });
  lines.push_back({"samples"});
  for (const auto& [title, distances] : columns)
    lines.back().push_back(fmt::format("{}", distances->stats.count));
  return text::aligned_columns(lines);
}

std::string thresholds_text(const mesh_error::MeshEvaluation& e) {
  Lines lines = {{"closer than [m]", "precision [%]", "recall [%]", "F [%]"}};
  if (e.not_culled) lines[0].emplace_back("recall of the whole ground truth [%]");
  for (std::size_t i = 0; i < e.errors.thresholds.size(); ++i) {
    const mesh_error::MeshThreshold& at = e.errors.thresholds[i];
    lines.push_back({text::seven_digits(at.tau_m), fmt::format("{:.2f}", 100 * at.precision),
                     fmt::format("{:.2f}", 100 * at.recall), fmt::format("{:.2f}", 100 * at.fscore)});
    if (e.not_culled) lines.back().push_back(fmt::format("{:.2f}", 100 * e.not_culled->thresholds[i].recall));
  }
  return text::aligned_columns(lines);
}

std::string surfreg_text(const mesh_error::SurfregScore& score) {
  const std::string mean =
      fmt::format("{} m, mean distance of vertices to vertices", text::seven_digits(score.vertex_mean_m));
  if (!score.after_icp_m) return mean;
  return fmt::format("{}; {} m after its ICP", mean,
                     text::seven_digits(std::min(score.vertex_mean_m, *score.after_icp_m)));
}

Json json_of(const std::string& file, const mesh_error::MeshShape& shape) {
  return {{"file", file},
          {"vertices", shape.vertices},
          {"unused_vertices", shape.unused_vertices},
          {"triangles", shape.triangles},
          {"surfels", shape.surfels},
          {"extent_m", {shape.extent_m.x(), shape.extent_m.y(), shape.extent_m.z()}}};
}

Json culling_json(const mesh_error::MeshEvaluation& e, const mesh_error::MeshRequest& request,
                  const ComparedMeshes& files) {
  if (!request.views) return {{"mode", "none"}};
  return {{"mode", mesh_error::to_string(request.views->culling)},
          {"recording", files.recording},
          {"views", request.views->T_truth_camera.size()},
          {"min_depth_m", request.views->min_depth_m},
          {"max_depth_m", request.views->max_depth_m},
          {"observed", e.truth_observed},
          {"observed_share", observed_share(e)}};
}

Json icp_json(const mesh_error::MeshEvaluation& evaluation, const mesh_error::MeshRequest& request) {
  const mesh_error::RegistrationResult& icp = *evaluation.icp;
  return {{"start", trajectory_error::json_of(request.start)},
          {"kept", request.icp->kept},
          {"steps", icp.steps},
          {"converged", icp.converged},
          {"kept_rms_m", icp.kept_rms_m},
          {"free_directions", icp.free_directions},
          {"doubt", evaluation.icp_doubt.empty() ? Json(nullptr) : Json(evaluation.icp_doubt)}};
}

}  // namespace

std::string to_text(const mesh_error::MeshEvaluation& evaluation, const mesh_error::MeshRequest& request,
                    const ComparedMeshes& files) {
  Lines heading = {{"reconstruction", shape_text(files.reconstruction, evaluation.reconstruction)},
                   {"truth", shape_text(files.truth, evaluation.truth)}};
  if (files.scale != 1)
    heading.push_back({"scale", fmt::format("the reconstruction times {:g}", files.scale)});
  heading.push_back({"alignment", alignment_text(evaluation, request)});
  heading.push_back(
      {"samples", fmt::format("reconstruction: {}; truth: {}",
                              samples_text(request.errors.reconstruction, evaluation.reconstruction_samples),
                              samples_text(request.errors.truth, evaluation.truth_samples))});
  heading.push_back({"culling", culling_text(evaluation, request, files)});
  std::string text = "mesh error: exact distances to triangles\n\n" + text::aligned_columns(heading) + "\n";
  text += statistics_text(evaluation) + "\n" + thresholds_text(evaluation) + "\n";
  Lines summary = {{"Chamfer", text::seven_digits(evaluation.errors.chamfer_m) + " m, mean of both means"},
                   {"SurfReg", surfreg_text(evaluation.surfreg)}};
  if (evaluation.errors.ghost_share)
    summary.push_back(
        {"ghosts", fmt::format("{:.2f} % are more than {:g} cm in front of the ground truth, in free space",
                               100 * *evaluation.errors.ghost_share, 100 * mesh_error::kGhostDistance_m)});
  return text + text::aligned_columns(summary);
}

std::string to_json(const mesh_error::MeshEvaluation& evaluation, const mesh_error::MeshRequest& request,
                    const ComparedMeshes& files) {
  const mesh_error::MeshErrorOptions& options = request.errors;
  Json json = {{"metric", "mesh"},
               {"unit", "m"},
               {"protocol",
                "exact distances to triangles; accuracy: reconstruction to truth; completeness: "
                "observed truth to reconstruction"},
               {"reconstruction", json_of(files.reconstruction, evaluation.reconstruction)},
               {"truth", json_of(files.truth, evaluation.truth)},
               {"scale", files.scale}};
  json["samples"] = {
      {"reconstruction", mesh_error::json_of(options.reconstruction, evaluation.reconstruction_samples)},
      {"truth", mesh_error::json_of(options.truth, evaluation.truth_samples)}};
  json["culling"] = culling_json(evaluation, request, files);
  json.update(mesh_error::json_of(evaluation.errors));
  const mesh_error::SurfregScore& surfreg = evaluation.surfreg;
  json["surfreg_m"] = surfreg.vertex_mean_m;
  json["surfreg_icp_m"] =
      surfreg.after_icp_m ? Json(std::min(surfreg.vertex_mean_m, *surfreg.after_icp_m)) : Json(nullptr);
  if (evaluation.icp) json["icp"] = icp_json(evaluation, request);
  if (evaluation.not_culled) json["not_culled"] = mesh_error::json_of(*evaluation.not_culled);
  return text::json_text(json) + "\n";
}

}  // namespace fusebench::metric_reports
