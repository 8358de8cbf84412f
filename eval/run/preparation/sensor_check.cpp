#include "eval/run/preparation/sensor_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <vector>

#include "core/base/io/staged_file.hpp"
#include "datasets/inspection/inspection.hpp"
#include "eval/run/preparation/preparation.hpp"
#include "eval/run/preparation/prepared_recording.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::preparation {

namespace {

using Json = nlohmann::ordered_json;
using inspection::Finding;
using inspection::Severity;

constexpr std::array<std::string_view, 5> kOfImu = {"imu-", "gyroscope-", "accelerometer-", "gravity-",
                                                    "extrinsic-"};
constexpr std::array<std::string_view, 8> kOfImages = {
    "color-mirrored", "depth-along-ray", "depth-time-offset", "depth-misregistered",
    "depth-range",    "depth-scale",     "focal-length",      "image-size"};
/// A run can do nothing about these, but what it measures by such a ground truth means nothing.
constexpr std::array<std::string_view, 8> kOfTruth = {
    "truth-not-reflected", "truth-inverted",      "truth-rotation-inverted", "truth-quaternion-order",
    "truth-camera-axes",   "truth-position-axes", "truth-constant",          "truth-inconsistent"};
constexpr std::array<std::string_view, 8> kInvalidating = {
    "gyroscope-unit",     "gyroscope-axes",     "accelerometer-unit", "accelerometer-without-gravity",
    "accelerometer-sign", "accelerometer-axes", "imu-axes-swapped",   "imu-unrelated"};

constexpr double kKnownOffset_s = kLeastTimeOffset_s / 3;  // standard deviation: less is told apart from none

bool has_recorded_imu(const recording::Recording& recording) {
  return recording.imu_source == recording::ImuSource::recorded;
}

/// Of the file of checks: which samples there are decides what is checked.
std::string_view extension_of(recording::ImuSource source) {
  switch (source) {
    case recording::ImuSource::recorded:
      return ".imu.checks.json";
    case recording::ImuSource::synthetic:
      return ".synthetic-imu.checks.json";
    case recording::ImuSource::none:
      break;
  }
  return ".checks.json";
}

bool is_of_sensors(const Finding& finding, bool with_imu) {
  if (finding.severity == Severity::note) return false;
  if (std::ranges::find(kOfImages, finding.code) != kOfImages.end()) return true;
  if (std::ranges::find(kOfTruth, finding.code) != kOfTruth.end()) return finding.severity == Severity::error;
  return with_imu &&
         std::ranges::any_of(kOfImu, [&](std::string_view of) { return finding.code.starts_with(of); });
}

SensorCheck sensor_check_of(const Json& json) {
  SensorCheck result;
  for (const Json& finding : json.at("findings")) {
    const bool is_error = finding.at("severity") == to_string(Severity::error);
    result.findings.push_back({finding.at("code"), is_error ? Severity::error : Severity::warning,
                               finding.at("message"), finding.at("hint")});
  }
  if (const auto bias = json.find("gyroscope_bias_radps"); bias != json.end())
    result.gyroscope_bias_radps = Vector3d(bias->at(0), bias->at(1), bias->at(2));
  if (const auto offset = json.find("imu_time_offset_s"); offset != json.end())
    result.imu_time_offset_s = offset->get<double>();
  if (const auto camera = json.find("depth_camera"); camera != json.end())
    result.depth_camera = depth_camera_of(*camera);
  return result;
}

/// Nothing if there is no such file, or if it is damaged.
std::optional<SensorCheck> kept_check(const std::filesystem::path& file) {
  std::ifstream text(file);
  if (!text) return std::nullopt;
  try {
    return sensor_check_of(Json::parse(text));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Ground truth must not reach the estimator.
bool is_independent_of_truth(const inspection::ImuMeasurement& imu) {
  return imu.bias_source == "at rest" || imu.bias_source == "images";
}

}  // namespace

nlohmann::ordered_json json_of(const SensorCheck& result) {
  Json json = {{"findings", Json::array()}};
  for (const Finding& finding : result.findings)
    json["findings"].push_back({{"severity", to_string(finding.severity)},
                                {"code", finding.code},
                                {"message", finding.message},
                                {"hint", finding.hint}});
  if (const auto& bias = result.gyroscope_bias_radps)
    json["gyroscope_bias_radps"] = {bias->x(), bias->y(), bias->z()};
  if (result.imu_time_offset_s) json["imu_time_offset_s"] = *result.imu_time_offset_s;
  if (result.depth_camera) json["depth_camera"] = json_of(*result.depth_camera);
  return json;
}

SensorCheck inspected_sensors(const recording::Recording& recording, const Workers& workers) {
  const inspection::Inspection inspected = inspection::inspect(recording, workers);
  SensorCheck result;
  const bool with_imu = has_recorded_imu(recording);
  std::ranges::copy_if(inspected.findings, std::back_inserter(result.findings),
                       [&](const Finding& finding) { return is_of_sensors(finding, with_imu); });
  if (inspected.registration) result.depth_camera = measured_depth_camera(*inspected.registration);
  if (result.depth_camera && result.depth_camera->is_used)
    std::erase_if(result.findings, [](const Finding& f) {
      return f.code == "depth-misregistered" || f.code == "focal-length";  // by depth of the wrong camera
    });
  if (with_imu && inspected.imu && is_independent_of_truth(*inspected.imu))
    result.gyroscope_bias_radps = inspected.imu->gyroscope_bias_radps;
  // Without ground truth the inspection has compared the IMU with the images already.
  const bool compared = inspected.imu_alignment && inspected.imu_alignment->source == "images" &&
                        !inspected.has("imu-unrelated");
  const auto alignment =
      compared ? inspected.imu_alignment : inspection::align_imu_with_images(recording, workers);
  if (alignment && alignment->time_offset_sigma_s < kKnownOffset_s)
    result.imu_time_offset_s = alignment->time_offset_s;
  if (std::abs(result.imu_time_offset_s.value_or(0)) >= kLeastTimeOffset_s)  // a run removes it
    std::erase_if(result.findings, [](const Finding& f) { return f.code == "imu-time-offset"; });
  return result;
}

SensorCheck check_sensors(const recording::Recording& recording, const std::filesystem::path& out,
                          const Workers& workers) {
  const std::filesystem::path file =
      preparation_file(out, recording).replace_extension(extension_of(recording.imu_source));
  if (auto kept = kept_check(file)) return *std::move(kept);
  SensorCheck result = inspected_sensors(recording, workers);
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (!failed) std::ignore = io::write_file_atomically(file, text::json_text(json_of(result)) + "\n");
  return result;
}

void take_out_bias(recording::Recording& recording, const Vector3d& bias_radps) {
  if (bias_radps.norm() < kLeastBias_radps) return;
  for (ImuSample& sample : recording.imu) sample.angular_velocity_radps -= bias_radps;
  for (filter::StampedState& truth : recording.state_truth) truth.state.gyroscope_bias_radps -= bias_radps;
  recording.notes.push_back(
      fmt::format("{}bias of the gyroscope ({:.4f}, {:.4f}, {:.4f}) rad/s, measured in the recording and "
                  "taken out of its samples",
                  kPreparedNote, bias_radps.x(), bias_radps.y(), bias_radps.z()));
}

void take_out_time_offset(recording::Recording& recording, double imu_time_offset_s) {
  std::vector<ImuSample>& imu = recording.imu;
  if (imu.empty() || std::abs(imu_time_offset_s) < kLeastTimeOffset_s) return;
  const ImuSample first = imu.front(), last = imu.back();
  const std::int64_t offset_ns = std::llround(1e9 * imu_time_offset_s);
  for (ImuSample& sample : imu) sample.timestamp_ns -= offset_ns;
  if (imu.front().timestamp_ns > first.timestamp_ns) imu.insert(imu.begin(), first);
  if (imu.back().timestamp_ns < last.timestamp_ns) imu.push_back(last);
  for (filter::StampedState& truth : recording.state_truth)
    truth.state.imu_time_offset_s -= imu_time_offset_s;
  recording.notes.push_back(
      fmt::format("{}stamps of the IMU {:+.1f} ms against those of the images, measured in the recording and "
                  "taken out of its samples",
                  kPreparedNote, 1e3 * imu_time_offset_s));
}

std::optional<Error> refusal(const SensorCheck& check, const std::string& recording) {
  std::string messages, hints;
  for (const Finding& finding : check.findings) {
    if (!makes_results_invalid(finding)) continue;
    messages += fmt::format("{}{}", messages.empty() ? "" : "; ", finding.message);
    hints += fmt::format("{}{}", hints.empty() || finding.hint.empty() ? "" : "; ", finding.hint);
  }
  if (messages.empty()) return std::nullopt;
  return Error{ErrorCode::data_corrupt, fmt::format("the IMU of '{}': {}", recording, messages), hints};
}

bool makes_results_invalid(const Finding& finding) {
  return finding.severity == Severity::error &&
         std::ranges::find(kInvalidating, finding.code) != kInvalidating.end();
}

}  // namespace fusebench::preparation
