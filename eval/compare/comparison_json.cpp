#include <nlohmann/json.hpp>

#include "eval/compare/comparison_formats.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::compare {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kComparisonSchema = 1;

Json json_of(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json json_of(const RunSide& side) {
  Json json = Json::array();
  for (const run_files::FoundRun* run : side.all()) json.push_back(run->folder.string());
  return json;
}

Json json_of(const GateResult& gate) {
  std::optional<double> ratio;
  if (gate.fresh && gate.base && *gate.base != 0) ratio = *gate.fresh / *gate.base;
  return {{"gate", gate.gate},
          {"verdict", to_string(gate.verdict)},
          {"fails", gate.fails},
          {"unit", gate.unit},
          {"base", json_of(gate.base)},
          {"new", json_of(gate.fresh)},
          {"tolerance", json_of(gate.tolerance)},
          {"ratio", json_of(ratio)},
          {"better", gate.better ? Json(to_string(*gate.better)) : Json(nullptr)},
          {"p", json_of(gate.p)},
          {"message", gate.message},
          {"not_gated", gate.not_gated}};
}

Json json_of(const std::optional<Divergence>& divergence) {
  if (!divergence) return nullptr;
  return {{"frame", divergence->frame},
          {"stamp", divergence->stamp},
          {"moved_m", json_of(divergence->moved_m)},
          {"turned_rad", json_of(divergence->turned_rad)},
          {"only_in", divergence->only_in}};
}

Json json_of(const ComparedRun& run) {
  Json gates = Json::array();
  for (const GateResult& gate : run.gates) gates.push_back(json_of(gate));
  const run_files::RunIdentity& experiment = run.runs.experiment;
  return {{"label", run.runs.label},
          {"recording", experiment.recording},
          {"variant", experiment.variant},
          {"first_frame", experiment.first_frame},
          {"frames", experiment.frames},
          {"imu", experiment.imu},
          {"options", options_text(experiment)},
          {"base", json_of(run.runs.base)},
          {"new", json_of(run.runs.fresh)},
          {"bit_identical", run.is_identical},
          {"divergence", json_of(run.divergence)},
          {"gates", gates}};
}

}  // namespace

std::string comparison_json(const RunComparison& comparison) {
  Json runs = Json::array();
  for (const ComparedRun& run : comparison.runs) runs.push_back(json_of(run));
  Json moved_first = Json::array();
  for (const ComparedRun* run : comparison.diverging()) moved_first.push_back(run->runs.label);
  return text::json_text(Json{{"schema", kComparisonSchema},
                              {"passed", comparison.passed()},
                              {"failures", comparison.failures()},
                              {"regressions", comparison.count(GateVerdict::regression)},
                              {"changed", comparison.count(GateVerdict::changed)},
                              {"improvements", comparison.count(GateVerdict::improvement)},
                              {"possible_slowdowns", comparison.count(GateVerdict::suspect)},
                              {"notes", comparison.notes},
                              {"bit_identical", comparison.identical()},
                              {"diverging", moved_first},
                              {"runs", runs}}) +
         "\n";
}

}  // namespace fusebench::compare
