#include "eval/metrics/mesh_error/mesh_json.hpp"

#include <utility>

#include "eval/metrics/statistics_json.hpp"
#include "eval/metrics/trajectory_error/alignment_json.hpp"

namespace fusebench::mesh_error {

using Json = nlohmann::ordered_json;

Json json_of(const MeshDistances& distances) {
  Json json = metrics::json_of(distances.stats);
  if (!json.is_null()) {
    json["p90"] = distances.p90;
    json["p95"] = distances.p95;
  }
  return json;
}

Json json_of(const MeshErrorResult& mesh) {
  Json thresholds = Json::array();
  for (const MeshThreshold& at : mesh.thresholds) {
    thresholds.push_back(
        {{"tau_m", at.tau_m}, {"precision", at.precision}, {"recall", at.recall}, {"fscore", at.fscore}});
  }
  return {{"alignment", trajectory_error::json_of(mesh.alignment)},
          {"accuracy", json_of(mesh.accuracy)},
          {"completeness", json_of(mesh.completeness)},
          {"chamfer_m", mesh.chamfer_m},
          {"ghost_share", mesh.ghost_share ? Json(*mesh.ghost_share) : Json(nullptr)},
          {"thresholds", std::move(thresholds)}};
}

Json json_of(const MeshSampling& sampling, std::size_t points) {
  return {{"from", to_string(sampling.from)},
          {"count", sampling.count},
          {"seed", sampling.seed},
          {"points", points}};
}

}  // namespace fusebench::mesh_error
