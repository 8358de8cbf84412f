// What contradicts the calibration of a recording, looked for before it is run.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/inspection/finding.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/run/preparation/depth_camera.hpp"

namespace fusebench::preparation {

struct SensorCheck {
  /// Errors and warnings of `fusebench inspect` about the cameras and about recorded inertial samples, and
  /// its errors about the poses of the ground truth.
  std::vector<inspection::Finding> findings;
  /// Of a recorded IMU: at rest, or else by the turns of the camera in the images; nothing where neither
  /// makes it observable.
  std::optional<Vector3d> gyroscope_bias_radps;
  /// IMU's stamp minus camera's stamp of one instant, by the turns of the camera in the images; nothing where
  /// these do not make it observable. A synthetic IMU has the error of the ground truth's clock.
  std::optional<double> imu_time_offset_s;
  /// By the edges of depth and colour; nothing where depth has too few edges. If it is used, the findings do
  /// not have depth-misregistered and focal-length, which were found with the depth as it was read.
  std::optional<MeasuredDepthCamera> depth_camera;
};

[[nodiscard]] SensorCheck inspected_sensors(const recording::Recording& recording, const Workers& workers);

/// The same, measured once: the result is kept as <out>/prepared/<recording>-<16 digits>.checks.json.
[[nodiscard]] SensorCheck check_sensors(const recording::Recording& recording,
                                        const std::filesystem::path& out, const Workers& workers);

/// For programs, and as it is kept.
[[nodiscard]] nlohmann::ordered_json json_of(const SensorCheck& check);

/// Whether no result of such samples means anything: another unit, gravity that is missing, axes that are
/// exchanged, or the IMU of another recording.
[[nodiscard]] bool makes_results_invalid(const inspection::Finding& finding);

/// All findings that make results invalid as one error (data_corrupt), with what to do; nothing if there are
/// none.
[[nodiscard]] std::optional<Error> refusal(const SensorCheck& check, const std::string& recording);

/// Takes the bias out of the samples and the true states, with a note, if it is larger than kLeastBias_radps:
/// the filter expects one of 0.005 rad/s (initialisation.gyroscope_bias_sigma_radps) and would take longer to
/// find it.
void take_out_bias(recording::Recording& recording, const Vector3d& gyroscope_bias_radps);
inline constexpr double kLeastBias_radps = 0.015;

/// Moves the stamps of the samples by -imu_time_offset_s, with a note, if the offset is larger than
/// kLeastTimeOffset_s, which is the standard deviation that the filter expects
/// (initialisation.imu_time_offset_sigma_s). The first and the last sample are held where frames would be
/// left without samples.
void take_out_time_offset(recording::Recording& recording, double imu_time_offset_s);
inline constexpr double kLeastTimeOffset_s = 0.01;

}  // namespace fusebench::preparation
