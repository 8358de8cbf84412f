#include "eval/record/record_loops.hpp"

namespace fusebench::record {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const loop_error::Revisits& revisits) {
  return {{"count", revisits.count}, {"found", revisits.found}};
}

loop_error::Revisits revisits_of(const Json& json) { return {json.at("count"), json.at("found")}; }

}  // namespace

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
