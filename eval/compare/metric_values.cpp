#include "eval/compare/metric_values.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace fusebench::compare {

namespace {

record::Outcome<double> finite(double value) {
  if (std::isfinite(value)) return {value, {}};
  return {std::nullopt, "the record has no finite number"};
}

template <class T, class Read>
record::Outcome<double> read_from(const record::Outcome<T>& outcome, Read read) {
  if (!outcome.value) return {std::nullopt, outcome.reason};
  return finite(read(*outcome.value));
}

record::Outcome<double> count(std::size_t value) { return {static_cast<double>(value), {}}; }

record::Outcome<double> coverage(const record::RunRecord& record) {
  if (record.frames.total == 0) return {std::nullopt, "no frames"};
  return finite(static_cast<double>(record.frames.tracked) / static_cast<double>(record.frames.total));
}

record::Outcome<double> fscore(const record::RunRecord& record) {
  const auto& mesh = record.metrics.mesh;
  if (mesh.value && mesh.value->poses.thresholds.empty()) return {std::nullopt, "no threshold"};
  return read_from(mesh, [](const record::RecordedMesh& m) { return m.poses.thresholds.front().fscore; });
}

constexpr auto kSmaller = BetterValue::smaller;
constexpr auto kLarger = BetterValue::larger;
constexpr auto kEqual = BetterValue::equal;

constexpr std::array<GatedMetric, 13> kMetrics = {{
    {"ate_rmse_m", "m", "ATE, rmse", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.ate, [](const trajectory_error::AteResult& m) { return m.stats.rmse; });
     }},
    {"rpe_frame_m", "m", "RPE over a frame, rmse", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.rpe_frame,
                        [](const trajectory_error::RpeResult& m) { return m.translation.rmse; });
     }},
    {"rpe_frame_rad", "rad", "RPE over a frame, rotation, rmse", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.rpe_frame,
                        [](const trajectory_error::RpeResult& m) { return m.rotation.rmse; });
     }},
    {"rpe_1s_m", "m", "RPE over 1 s, rmse", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.rpe_second,
                        [](const trajectory_error::RpeResult& m) { return m.translation.rmse; });
     }},
    {"rpe_1s_rad", "rad", "RPE over 1 s, rotation, rmse", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.rpe_second,
                        [](const trajectory_error::RpeResult& m) { return m.rotation.rmse; });
     }},
    {"aie_grey", "grey", "average intensity error", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.aie, [](const metrics::IntensityResult& m) { return m.all.aie_grey; });
     }},
    {"mesh_accuracy_m", "m", "mesh accuracy, mean", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.mesh,
                        [](const record::RecordedMesh& m) { return m.poses.accuracy.stats.mean; });
     }},
    {"mesh_completeness_m", "m", "mesh completeness, mean", kSmaller, false,
     [](const record::RunRecord& r) {
       return read_from(r.metrics.mesh,
                        [](const record::RecordedMesh& m) { return m.poses.completeness.stats.mean; });
     }},
    {"mesh_fscore", "1", "F-score at the first threshold", kLarger, false, fscore},
    {"coverage", "1", "tracked frames / frames", kLarger, true, coverage},
    {"frames_tracked", "frames", "tracked frames", kLarger, true,
     [](const record::RunRecord& r) { return count(r.frames.tracked); }},
    {"frames_total", "frames", "frames of the run", kEqual, true,
     [](const record::RunRecord& r) { return count(r.frames.total); }},
    {"model_vertices", "vertices", "vertices of the model's mesh", kEqual, true,
     [](const record::RunRecord& r) { return count(r.model.vertices); }},
}};

std::optional<double> positive(double value) {
  return std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

constexpr std::array<TimedQuantity, 3> kTimed = {{
    {"cpu_s_per_frame", "s", "CPU time of a frame", 1.10,
     [](const record::RunRecord& r) {
       // A run that was lost early must not look fast: only what was processed counts.
       const std::size_t processed = r.frames.tracked + r.frames.lost;
       return processed == 0 ? std::nullopt : positive(r.timing.cpu_s / static_cast<double>(processed));
     }},
    {"wall_s", "s", "time of the run", 1.25,
     [](const record::RunRecord& r) { return positive(r.timing.wall_s); }},
    {"peak_rss_bytes", "B", "peak memory", 1.10,
     [](const record::RunRecord& r) { return positive(static_cast<double>(r.timing.peak_rss_bytes)); }},
}};

}  // namespace

std::string_view to_string(BetterValue better) {
  switch (better) {
    case BetterValue::smaller:
      return "smaller";
    case BetterValue::larger:
      return "larger";
    case BetterValue::equal:
      break;
  }
  return "equal";
}

std::string quantity_text(double value, std::string_view unit) {
  return unit == "1" ? fmt::format("{:.6g}", value) : fmt::format("{:.6g} {}", value, unit);
}

std::span<const GatedMetric> gated_metrics() { return kMetrics; }
std::span<const TimedQuantity> timed_quantities() { return kTimed; }

}  // namespace fusebench::compare
