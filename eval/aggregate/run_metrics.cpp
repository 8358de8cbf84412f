#include "eval/aggregate/run_metrics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/nearest_name.hpp"

namespace fusebench::aggregate {

std::span<const RunMetric> run_metrics() {
  static constexpr auto kMetrics = std::to_array<RunMetric>({
      {"ate_rmse_m", "ate", "m", "ATE [cm]", 100, 2, false, true, &RunNumbers::ate_rmse_m},
      {"rpe_frame_m", "", "m", "RPE frame [mm]", 1000, 2, false, true, &RunNumbers::rpe_frame_m},
      {"rpe_1s_m", "rpe", "m", "RPE [cm/s]", 100, 2, false, true, &RunNumbers::rpe_second_m},
      {"rpe_1s_rad", "", "rad", "RPE [deg/s]", kDegreesPerRadian, 3, false, true,
       &RunNumbers::rpe_second_rad},
      {"aie_grey", "aie", "grey", "AIE", 1, 3, false, true, &RunNumbers::aie_grey},
      {"mesh_accuracy_m", "mesh", "m", "mesh accuracy [mm]", 1000, 2, false, true,
       &RunNumbers::mesh_accuracy_m},
      {"mesh_completeness_m", "", "m", "mesh completeness [mm]", 1000, 2, false, true,
       &RunNumbers::mesh_completeness_m},
      {"silent_failures", "silent", "frames", "silent", 1, 0, false, true, &RunNumbers::silent_failures},
      {"cpu_s", "cpu", "s", "CPU [s]", 1, 2, true, true, &RunNumbers::cpu_s},
      {"wall_s", "wall", "s", "wall clock [s]", 1, 2, true, true, &RunNumbers::wall_s},
      {"peak_rss_bytes", "memory", "bytes", "peak memory [MB]", 1e-6, 0, true, true,
       &RunNumbers::peak_rss_bytes},
      {"fps", "", "1/s", "fps", 1, 1, true, false, &RunNumbers::fps},
      {"cpu_ms_per_frame", "", "ms", "CPU [ms/frame]", 1, 2, true, true, &RunNumbers::cpu_ms_per_frame},
  });
  return kMetrics;
}

Result<const RunMetric*> find_run_metric(std::string_view name) {
  std::vector<std::string> allowed;
  for (const RunMetric& metric : run_metrics()) {
    if (!metric.less_is_better) continue;
    if (name == metric.key || (!metric.word.empty() && name == metric.word)) return &metric;
    allowed.emplace_back(metric.word.empty() ? metric.key : metric.word);
  }
  return fail(ErrorCode::usage, fmt::format("{} is no metric to rank by (allowed: {}){}", name,
                                            fmt::join(allowed, " | "), nearest_hint(name, allowed)));
}

}  // namespace fusebench::aggregate
