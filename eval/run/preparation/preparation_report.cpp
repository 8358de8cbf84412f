#include "eval/run/preparation/preparation_report.hpp"

#include <fmt/format.h>

#include "eval/text/json_text.hpp"

namespace fusebench::preparation {

namespace {

using Json = nlohmann::ordered_json;

std::string sensors_text(const SensorCheck& sensors) {
  std::string text = "\n";
  if (const auto& bias = sensors.gyroscope_bias_radps)
    text +=
        fmt::format("gyroscope bias ({:.4f}, {:.4f}, {:.4f}) rad/s; {}\n", bias->x(), bias->y(), bias->z(),
                    bias->norm() < kLeastBias_radps ? "small enough for the filter to find"
                                                    : "a run takes it out of the samples");
  if (sensors.depth_camera) text += to_line(*sensors.depth_camera) + "\n";
  if (sensors.findings.empty()) text += "nothing contradicts the calibration\n";
  for (const inspection::Finding& finding : sensors.findings)
    text += fmt::format("{}: {}{}\n", to_string(finding.severity), finding.message,
                        makes_results_invalid(finding) ? "; a run refuses it" : "");
  return text;
}

std::string_view meaning(Verdict verdict) {
  switch (verdict) {
    case Verdict::held:
      return "held: the calibration gives no uncertainty";
    case Verdict::measured:
      return "measured";
    case Verdict::agrees:
      return "the calibration's: the measurement agrees with it";
    case Verdict::open:
      break;
  }
  return "the calibration's: the recording tells no more";
}

std::string milliseconds(double value_s, double sigma_s) {
  return fmt::format("{:.1f} +- {:.1f}", 1e3 * value_s, 1e3 * sigma_s);
}

}  // namespace

std::string to_text(const Preparation& preparation, const SensorCheck& sensors,
                    const recording::Recording& recording) {
  std::string text =
      fmt::format("{}: {} of {} frames looked at, {} tracked, {} pairs of frames\n\n", recording.name,
                  preparation.frames, recording.frames.size(), preparation.tracked, preparation.pairs);
  text += fmt::format("{:<15}{:>16}{:>16}{:>16}\n", "ms", "calibration", "measured", "used");
  for (const PreparedConstant& constant : preparation.constants) {
    const bool measured = constant.measured_sigma_s > 0;
    text += fmt::format("{:<15}{:>16}{:>16}{:>16}  {}\n", constant.name,
                        milliseconds(constant.before_s, constant.before_sigma_s),
                        measured ? milliseconds(constant.measured_s, constant.measured_sigma_s) : "-",
                        milliseconds(constant.after_s, constant.after_sigma_s), meaning(constant.verdict));
  }
  return text + sensors_text(sensors);
}

std::string to_json(const Preparation& preparation, const SensorCheck& sensors,
                    const recording::Recording& recording) {
  Json json = {{"recording", recording.name},
               {"frames", preparation.frames},
               {"tracked", preparation.tracked},
               {"pairs", preparation.pairs},
               {"constants", Json::object()}};
  for (const PreparedConstant& constant : preparation.constants) {
    Json entry = {{"before_s", constant.before_s}, {"before_sigma_s", constant.before_sigma_s}};
    if (constant.measured_sigma_s > 0) {
      entry["measured_s"] = constant.measured_s;
      entry["measured_sigma_s"] = constant.measured_sigma_s;
    }
    entry["after_s"] = constant.after_s;
    entry["after_sigma_s"] = constant.after_sigma_s;
    entry["verdict"] = to_string(constant.verdict);
    json["constants"][std::string(constant.name)] = std::move(entry);
  }
  json["sensors"] = json_of(sensors);
  return text::json_text(json) + "\n";
}

}  // namespace fusebench::preparation
