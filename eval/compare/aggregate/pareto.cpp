#include "eval/compare/aggregate/pareto.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/error.hpp"
#include "eval/compare/aggregate/configurations.hpp"

namespace fusebench::aggregate {

namespace {

const registry::RunMetric& time_metric() { return registry::run_metric("cpu_ms_per_frame"); }

/// Points are by time: whoever comes later must have a better value than all before.
void mark_front(std::vector<ParetoPoint>& points) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() && points[end].cpu_ms_per_frame == points[begin].cpu_ms_per_frame) ++end;
    const double least = points[begin].value;  // of the same time
    for (std::size_t i = begin; i < end; ++i) points[i].on_front = points[i].value == least && least < best;
    best = std::min(best, least);
    begin = end;
  }
}

}  // namespace

std::vector<ParetoPoint> ParetoFront::front() const {
  std::vector<ParetoPoint> front;
  std::ranges::copy_if(points, std::back_inserter(front), &ParetoPoint::on_front);
  return front;
}

ParetoFront pareto_front(std::span<const RunRow> rows, const registry::RunMetric& metric) {
  check(metric.better == registry::Better::smaller, "a metric in which less is better");
  std::vector<const RunRow*> runs;
  for (const RunRow& row : rows) runs.push_back(&row);
  ConfigurationSummaries values = summarise_configurations(runs, metric);
  // Time counts on the recordings that the value is of.
  std::erase_if(runs, [&](const RunRow* run) {
    return !std::ranges::binary_search(values.recordings, run->recorded_part());
  });
  const ConfigurationSummaries times = summarise_configurations(runs, time_metric());
  ParetoFront front{&metric, values.recordings, {}, 0};
  if (times.recordings != values.recordings) {  // somewhere no run was timed
    front.left_out = values.configurations.size();
    return front;
  }
  check(times.configurations.size() == values.configurations.size(), "both are of the same runs");
  for (std::size_t i = 0; i < values.configurations.size(); ++i) {
    const ConfigurationSummary& value = values.configurations[i];
    const ConfigurationSummary& time = times.configurations[i];
    if (value.complete() && time.complete()) {
      front.points.push_back({value.variant, value.options, *time.mean, *value.mean, false});
    } else {
      ++front.left_out;
    }
  }
  std::ranges::stable_sort(front.points, [](const ParetoPoint& a, const ParetoPoint& b) {
    return std::tie(a.cpu_ms_per_frame, a.value) < std::tie(b.cpu_ms_per_frame, b.value);
  });
  mark_front(front.points);
  return front;
}

}  // namespace fusebench::aggregate
