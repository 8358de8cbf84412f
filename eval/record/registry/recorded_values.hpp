// How metrics read a record: each function is one number of it, or why there is none.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/residual_metrics.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/record/record.hpp"

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

/// A number of an outcome: outcome.*Members[0].*Members[1] ...
template <auto... Members, class T>
[[nodiscard]] Value member_of(const record::Outcome<T>& outcome) {
  return read_from(outcome, [](const auto& m) { return (m.*....*Members); });
}
template <auto Outcome, auto... Members>
[[nodiscard]] Value of(const record::RunRecord& r) {
  return member_of<Members...>(r.metrics.*Outcome);
}
/// Of the poses as the system revised them at the end.
template <auto Outcome, auto... Members>
[[nodiscard]] Value revised(const record::RunRecord& r) {
  if (!r.final_metrics) return {std::nullopt, "the system did not revise its poses"};
  return member_of<Members...>((*r.final_metrics).*Outcome);
}
template <auto Member>
[[nodiscard]] Value of_loops(const record::RunRecord& r) {
  if (!r.loops) return {std::nullopt, "the system does not look for loops, or there is no truth"};
  return member_of<Member>(*r.loops);
}
/// One of the errors with the fitted offset of the clock.
template <auto Error>
[[nodiscard]] Value of_fitted_clock(const record::RunRecord& r) {
  const auto& clock = r.metrics.reference_clock;
  if (clock.value && !(clock.value->fitted.*Error)) return {std::nullopt, "no error with the fitted offset"};
  return read_from(clock, [](const auto& m) { return *(m.fitted.*Error); });
}
/// A count of frames; none of a run that did not begin.
template <std::size_t record::RecordedFrames::*Count>
[[nodiscard]] Value frame_count(const record::RunRecord& r) {
  if (r.frames.total == 0) return {std::nullopt, "the run did not begin"};
  return counted(r.frames.*Count);
}
/// A time or a size of zero was not measured.
template <auto Cost>
[[nodiscard]] Value timed(const record::RunRecord& r) {
  const auto value = static_cast<double>(r.timing.*Cost);
  if (std::isfinite(value) && value > 0) return {value, {}};
  return {std::nullopt, "the run was not timed"};
}
template <std::size_t Part>
[[nodiscard]] Value nees(const record::RunRecord& r) {
  return member_of<&metrics::NeesResult::stats, &metrics::Statistics::mean>(r.metrics.nees[Part]);
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
[[nodiscard]] inline Value coverage(const record::RunRecord& r) {
  return finite(record::coverage_share(r.frames));
}
[[nodiscard]] inline Value not_ok(const record::RunRecord& r) {
  return counted(r.status == record::RunStatus::ok ? 0 : 1);
}

}  // namespace fusebench::registry
