// How metrics read a record: each function is one number of it, or why there is none.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "eval/metrics/residual_metrics.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/record/record.hpp"
#include "eval/reference_clock/clocked_errors.hpp"
#include "eval/trajectory_error/ate_rpe.hpp"

namespace fusebench::registry {

using Value = record::Outcome<double>;
using Metrics = record::RecordedMetrics;

[[nodiscard]] inline Value finite(double value) {
  if (std::isfinite(value)) return {value, {}};
  return {std::nullopt, "the record has no finite number"};
}

/// read() of an outcome's value.
template <class T, class Read>
[[nodiscard]] Value read_from(const record::Outcome<T>& outcome, Read read) {
  if (!outcome.value) return {std::nullopt, outcome.reason};
  return finite(static_cast<double>(read(*outcome.value)));
}

[[nodiscard]] inline Value counted(std::size_t value) { return {static_cast<double>(value), {}}; }

/// A count of frames; none of a run that did not begin.
[[nodiscard]] inline Value frame_count(const record::RunRecord& r, std::size_t frames) {
  if (r.frames.total == 0) return {std::nullopt, "the run did not begin"};
  return counted(frames);
}

/// A time or a size of zero was not measured.
[[nodiscard]] inline Value positive(double value) {
  if (std::isfinite(value) && value > 0) return {value, {}};
  return {std::nullopt, "the run was not timed"};
}

[[nodiscard]] inline Value ate(const record::RunRecord& r) {
  return read_from(r.metrics.ate, [](const auto& m) { return m.stats.rmse; });
}
[[nodiscard]] inline Value ate_fitted(const record::RunRecord& r) {
  return read_from(r.metrics.ate_fitted, [](const auto& m) { return m.stats.rmse; });
}

template <record::Outcome<trajectory_error::RpeResult> Metrics::*Delta,
          metrics::Statistics trajectory_error::RpeResult::*Part>
[[nodiscard]] Value rpe(const record::RunRecord& r) {
  return read_from(r.metrics.*Delta, [](const auto& m) { return (m.*Part).rmse; });
}

/// A number of the poses as the system revised them at the end.
template <class Read>
[[nodiscard]] Value of_final(const record::RunRecord& r, Read read) {
  if (!r.final_metrics) return {std::nullopt, "the system did not revise its poses"};
  return read(*r.final_metrics);
}
[[nodiscard]] inline Value ate_revised(const record::RunRecord& r) {
  return of_final(r, [](const Metrics& metrics) {
    return read_from(metrics.ate, [](const auto& m) { return m.stats.rmse; });
  });
}
[[nodiscard]] inline Value rpe_revised(const record::RunRecord& r) {
  return of_final(r, [](const Metrics& metrics) {
    return read_from(metrics.rpe_second, [](const auto& m) { return m.translation.rmse; });
  });
}
[[nodiscard]] inline Value silent_revised(const record::RunRecord& r) {
  return of_final(r, [](const Metrics& metrics) {
    return read_from(metrics.silent, [](const auto& m) { return m.failures.silent; });
  });
}

[[nodiscard]] inline Value silent(const record::RunRecord& r) {
  return read_from(r.metrics.silent, [](const auto& m) { return m.failures.silent; });
}
[[nodiscard]] inline Value silent_judged(const record::RunRecord& r) {
  return read_from(r.metrics.silent, [](const auto& m) { return m.failures.judged; });
}

/// A number of the clock of the ground truth.
template <class Read>
[[nodiscard]] Value of_clock(const record::RunRecord& r, Read read) {
  return read_from(r.metrics.reference_clock, read);
}
/// One of the errors with the fitted offset.
template <class T>
[[nodiscard]] Value of_fitted_clock(const record::RunRecord& r,
                                    std::optional<T> reference_clock::ClockedErrors::*error) {
  const auto& clock = r.metrics.reference_clock;
  if (clock.value && !(clock.value->fitted.*error)) return {std::nullopt, "no error with the fitted offset"};
  return read_from(clock, [&](const auto& m) { return *(m.fitted.*error); });
}

[[nodiscard]] inline Value aie(const record::RunRecord& r) {
  return read_from(r.metrics.aie, [](const auto& m) { return m.all.aie_grey; });
}
[[nodiscard]] inline Value pose_aie(const record::RunRecord& r) {
  return read_from(r.metrics.pose_intensity, [](const auto& m) { return m.aie_grey; });
}

template <double metrics::ResidualSummary::*Part>
[[nodiscard]] Value residual(const record::RunRecord& r) {
  return read_from(r.metrics.residuals, [](const auto& m) { return m.*Part; });
}

[[nodiscard]] inline Value mesh_accuracy(const record::RunRecord& r) {
  return read_from(r.metrics.mesh, [](const auto& m) { return m.poses.accuracy.stats.mean; });
}
[[nodiscard]] inline Value mesh_completeness(const record::RunRecord& r) {
  return read_from(r.metrics.mesh, [](const auto& m) { return m.poses.completeness.stats.mean; });
}
[[nodiscard]] inline Value mesh_chamfer(const record::RunRecord& r) {
  return read_from(r.metrics.mesh, [](const auto& m) { return m.poses.chamfer_m; });
}
[[nodiscard]] inline Value mesh_fscore(const record::RunRecord& r) {
  const auto& mesh = r.metrics.mesh;
  if (mesh.value && mesh.value->poses.thresholds.empty()) return {std::nullopt, "no threshold"};
  return read_from(mesh, [](const auto& m) { return m.poses.thresholds.front().fscore; });
}
[[nodiscard]] inline Value mesh_ghosts(const record::RunRecord& r) {
  const auto& mesh = r.metrics.mesh;
  if (mesh.value && !mesh.value->poses.ghost_share) return {std::nullopt, "no free space is known"};
  return read_from(mesh, [](const auto& m) { return *m.poses.ghost_share; });
}

[[nodiscard]] inline Value model_vertices(const record::RunRecord& r) {
  if (r.model.vertices == 0) return {std::nullopt, "there is no reconstruction"};
  return counted(r.model.vertices);
}

template <std::size_t Part>
[[nodiscard]] Value nees(const record::RunRecord& r) {
  return read_from(r.metrics.nees[Part], [](const auto& m) { return m.stats.mean; });
}

/// A number of the loops.
template <class Read>
[[nodiscard]] Value of_loops(const record::RunRecord& r, Read read) {
  if (!r.loops) return {std::nullopt, "the system does not look for loops, or there is no truth"};
  return read_from(*r.loops, read);
}
[[nodiscard]] inline Value loops_accepted(const record::RunRecord& r) {
  return of_loops(r, [](const auto& loops) { return loops.accepted; });
}
[[nodiscard]] inline Value loops_false(const record::RunRecord& r) {
  return of_loops(r, [](const auto& loops) { return loops.false_accepted; });
}

}  // namespace fusebench::registry
