#include "eval/suites/study_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fusebench::suites {

namespace {

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> not_ok(const record::RunRecord& record) {
  return record.status == record::RunStatus::ok ? 0.0 : 1.0;
}

std::optional<double> lost_frames(const record::RunRecord& record) {
  if (record.frames.total == 0) return std::nullopt;  // it did not start
  return static_cast<double>(record.frames.lost);
}

std::optional<double> coverage(const record::RunRecord& record) {
  if (record.frames.total == 0) return 0.0;
  return static_cast<double>(record.frames.tracked) / static_cast<double>(record.frames.total);
}

std::optional<double> silent_failures(const record::RunRecord& record) {
  const auto silent = record.metrics.silent_frames();
  return silent ? std::optional(static_cast<double>(*silent)) : std::nullopt;
}

std::optional<double> silent_share(const record::RunRecord& record) {
  const auto& silent = record.metrics.silent.value;
  if (!silent) return std::nullopt;
  return static_cast<double>(silent->failures.silent) / static_cast<double>(silent->failures.judged);
}

std::optional<double> ate(const record::RunRecord& record) {
  const auto& ate = record.metrics.ate.value;
  return ate ? finite(ate->stats.rmse) : std::nullopt;
}

/// Of the poses as they were known at the end: the run's own, unless the system revised them.
std::optional<double> ate_final(const record::RunRecord& record) {
  const auto& ate = record.final_metrics ? record.final_metrics->ate.value : record.metrics.ate.value;
  return ate ? std::optional(ate->stats.rmse) : std::nullopt;
}

std::optional<double> ate_fitted(const record::RunRecord& record) {
  const auto& fit = record.metrics.ate_fitted.value;
  return fit ? finite(fit->stats.rmse) : std::nullopt;
}

template <record::Outcome<trajectory_error::RpeResult> record::RecordedMetrics::*Delta,
          metrics::Statistics trajectory_error::RpeResult::*Part>
std::optional<double> rpe(const record::RunRecord& record) {
  const auto& rpe = (record.metrics.*Delta).value;
  return rpe ? finite(((*rpe).*Part).rmse) : std::nullopt;
}

std::optional<double> aie(const record::RunRecord& record) {
  const auto& aie = record.metrics.aie.value;
  return aie ? finite(aie->all.aie_grey) : std::nullopt;
}

std::optional<double> mesh_accuracy(const record::RunRecord& record) {
  const auto& mesh = record.metrics.mesh.value;
  return mesh ? finite(mesh->poses.accuracy.stats.mean) : std::nullopt;
}

template <std::size_t Part>
std::optional<double> nees(const record::RunRecord& record) {
  const auto& part = record.metrics.nees[Part].value;
  return part ? finite(part->stats.mean) : std::nullopt;
}

std::optional<double> fps(const record::RunRecord& record) { return finite(record.timing.fps); }

using Metrics = record::RecordedMetrics;
constexpr auto kValues = std::to_array<StudyValue>({
    {.name = "runs_not_ok", .label = "not ok", .decimals = 0, .of_every_run = true, .of = not_ok},
    {.name = "lost_frames", .label = "lost frames", .decimals = 1, .of_every_run = true, .of = lost_frames},
    {.name = "coverage",
     .label = "coverage [%]",
     .shown_factor = 100,
     .decimals = 1,
     .higher_is_better = true,
     .of_every_run = true,
     .of = coverage},
    {.name = "silent_failures",
     .label = "silent failures",
     .decimals = 1,
     .of_every_run = true,
     .of = silent_failures},
    {.name = "silent_share",
     .label = "silent [%]",
     .shown_factor = 100,
     .decimals = 2,
     .of_every_run = true,
     .of = silent_share},
    {.name = "ate_rmse_m", .label = "ATE [cm]", .shown_factor = 100, .of = ate},
    {.name = "ate_final_m", .label = "ATE, final poses [cm]", .shown_factor = 100, .of = ate_final},
    {.name = "ate_fitted_m", .label = "ATE, offset fitted [cm]", .shown_factor = 100, .of = ate_fitted},
    {.name = "rpe_second_m",
     .label = "RPE 1 s [cm]",
     .shown_factor = 100,
     .of = rpe<&Metrics::rpe_second, &trajectory_error::RpeResult::translation>},
    {.name = "rpe_second_rad",
     .label = "RPE 1 s [deg]",
     .shown_factor = kDegreesPerRadian,
     .of = rpe<&Metrics::rpe_second, &trajectory_error::RpeResult::rotation>},
    {.name = "rpe_frame_m",
     .label = "RPE frame [mm]",
     .shown_factor = 1000,
     .of = rpe<&Metrics::rpe_frame, &trajectory_error::RpeResult::translation>},
    {.name = "rpe_frame_rad",
     .label = "RPE frame [deg]",
     .shown_factor = kDegreesPerRadian,
     .decimals = 3,
     .of = rpe<&Metrics::rpe_frame, &trajectory_error::RpeResult::rotation>},
    {.name = "aie_grey", .label = "AIE", .of = aie},
    {.name = kCommonPixelsValue, .label = "AIE common"},
    {.name = "mesh_accuracy_m", .label = "mesh accuracy [mm]", .shown_factor = 1000, .of = mesh_accuracy},
    {.name = "nees_orientation", .label = "NEES orientation", .nees_dof = 3, .of = nees<0>},
    {.name = "nees_position", .label = "NEES position", .nees_dof = 3, .of = nees<1>},
    {.name = "nees_velocity", .label = "NEES velocity", .nees_dof = 3, .of = nees<2>},
    {.name = "nees_gyroscope_bias", .label = "NEES gyro bias", .nees_dof = 3, .of = nees<3>},
    {.name = "nees_accelerometer_bias", .label = "NEES accel bias", .nees_dof = 3, .of = nees<4>},
    {.name = "nees_pose", .label = "NEES pose", .nees_dof = 6, .of = nees<5>},
    {.name = "fps", .label = "fps", .decimals = 1, .higher_is_better = true, .of = fps},
});

}  // namespace

std::span<const StudyValue> study_values() { return kValues; }

const StudyValue* find_study_value(std::string_view name) {
  const auto* const found = std::find_if(kValues.begin(), kValues.end(),
                                         [&](const StudyValue& value) { return value.name == name; });
  return found == kValues.end() ? nullptr : found;
}

}  // namespace fusebench::suites
