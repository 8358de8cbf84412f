// The numbers of NEW for programs that keep series of them: dashboards need one side only.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/printable.hpp"
#include "eval/compare/comparison_formats.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/record/registry/run_numbers.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::compare {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillisecondsPerSecond = 1000;

std::vector<double> numbers_of(const std::vector<run_files::FoundRun>& runs,
                               const registry::RunMetric& cost) {
  std::vector<double> numbers;
  for (const run_files::FoundRun& run : runs) {
    if (const auto value = registry::number_of(run.record, cost).value) numbers.push_back(*value);
  }
  return numbers;
}

/// The median and half of the range, with so few digits that a stored file does not change for nothing.
struct Middle {
  std::string value;
  std::string range;  // empty for a single number
};

Middle middle_of(const std::vector<double>& numbers) {
  const metrics::Statistics stats = metrics::statistics(numbers);
  Middle middle{fmt::format("{:.4g}", stats.median), {}};
  if (stats.count > 1) middle.range = fmt::format("± {:.2g}", (stats.max - stats.min) / 2);
  return middle;
}

Json gbench_entry(const ComparedRun& run, std::size_t family, std::size_t repetition) {
  const record::RunRecord& record = run.runs.fresh.runs[repetition].record;
  Json entry = {{"name", run.runs.label},
                {"family_index", family},
                {"per_family_instance_index", 0},
                {"run_name", run.runs.label},
                {"run_type", "iteration"},
                {"repetitions", run.runs.fresh.runs.size()},
                {"repetition_index", repetition},
                {"threads", record.provenance.threads},
                {"iterations", 1},
                {"real_time", record.timing.wall_s * kMillisecondsPerSecond},
                {"cpu_time", record.timing.cpu_s * kMillisecondsPerSecond},
                {"time_unit", "ms"},
                {"peak_rss_bytes", record.timing.peak_rss_bytes}};
  const registry::RunNumbers numbers = registry::numbers_of(record);
  for (const registry::RunMetric* metric : gated_metrics()) {
    if (const auto value = numbers[*metric]) entry[std::string(metric->key)] = *value;
  }
  return entry;
}

/// As a value of a label: \ " and line breaks are escaped, and printable() leaves none of the last.
std::string label_value(std::string_view text) {
  std::string result;
  for (const char c : printable(text, std::numeric_limits<std::size_t>::max())) {
    if (c == '\\' || c == '"') result += '\\';
    result += c;
  }
  return result;
}

std::string labels_of(const run_files::RunIdentity& experiment) {
  return fmt::format("recording=\"{}\",variant=\"{}\",frames=\"{}:{}\",imu=\"{}\",options=\"{}\"",
                     label_value(experiment.recording), label_value(experiment.variant),
                     experiment.first_frame, experiment.first_frame + experiment.frames,
                     label_value(experiment.imu), label_value(options_text(experiment)));
}

/// One family: all its samples stand together, as the format demands.
template <class Value>
std::string family(std::string_view key, std::string_view help, const RunComparison& comparison,
                   Value value) {
  const std::string name = fmt::format("fusebench_{}", key);
  std::string samples;
  for (const ComparedRun& run : comparison.runs) {
    if (run.runs.fresh.empty()) continue;
    const std::optional<std::string> number = value(run);
    if (number) samples += fmt::format("{}{{{}}} {}\n", name, labels_of(run.runs.experiment), *number);
  }
  if (samples.empty()) return {};
  return fmt::format("# TYPE {} gauge\n# HELP {} {}\n{}", name, name, help, samples);
}

std::string help_of(std::string_view title, std::string_view unit) {
  return unit == "1" ? std::string(title) : fmt::format("{} [{}]", title, unit);
}

void add_series(const ComparedRun& run, Json& series) {
  const record::RunRecord& record = run.runs.fresh.front().record;
  const auto name = [&](std::string_view key) { return fmt::format("{}: {}", run.runs.label, key); };
  const std::string git = fmt::format("git {}", record.provenance.git);
  const registry::RunNumbers numbers = registry::numbers_of(record);
  for (const registry::RunMetric* metric : gated_metrics()) {
    const auto value = numbers[*metric];
    // A chart whose alert is "larger" has no place for what is better when larger.
    if (metric->better != registry::Better::smaller || !value) continue;
    series.push_back(
        {{"name", name(metric->key)}, {"unit", metric->unit}, {"value", *value}, {"extra", git}});
  }
  if (record.frames.total > 0) {
    series.push_back({{"name", name("frames_not_tracked")},
                      {"unit", "frames"},
                      {"value", record.frames.total - std::min(record.frames.tracked, record.frames.total)},
                      {"extra", git}});
  }
  if (record.status != record::RunStatus::ok) return;
  for (const registry::RunMetric* cost : gated_costs()) {
    const std::vector<double> costs = numbers_of(run.runs.fresh.runs, *cost);
    if (costs.empty()) continue;
    Json entry = {
        {"name", name(cost->key)}, {"unit", cost->unit}, {"value", metrics::statistics(costs).median}};
    if (const Middle middle = middle_of(costs); !middle.range.empty()) entry["range"] = middle.range;
    entry["extra"] = fmt::format("{}, median of {} on {}", git, costs.size(), record.provenance.cpu);
    series.push_back(std::move(entry));
  }
}

}  // namespace

std::string comparison_gbench(const RunComparison& comparison) {
  Json context = {{"executable", "fusebench"}, {"library_build_type", "release"}, {"json_schema_version", 1}};
  Json benchmarks = Json::array();
  std::size_t left_out = 0;
  std::size_t families = 0;
  for (const ComparedRun& run : comparison.runs) {
    if (run.runs.fresh.empty()) continue;
    const record::RunRecord& first = run.runs.fresh.front().record;
    // A run that ended early is fast for no good reason.
    if (first.status != record::RunStatus::ok) {
      ++left_out;
      continue;
    }
    if (families == 0) {
      context["host_name"] = first.provenance.host;
      context["cpu"] = first.provenance.cpu;
      context["git"] = first.provenance.git;
      context["compiler"] = first.provenance.compiler;
      context["flags"] = first.provenance.flags;
    }
    for (std::size_t i = 0; i < run.runs.fresh.runs.size(); ++i)
      benchmarks.push_back(gbench_entry(run, families, i));
    ++families;
  }
  context["runs_left_out"] = left_out;
  return text::json_text(Json{{"context", context}, {"benchmarks", benchmarks}}) + "\n";
}

std::string comparison_github_benchmark(const RunComparison& comparison) {
  Json series = Json::array();
  for (const ComparedRun& run : comparison.runs) {
    if (!run.runs.fresh.empty()) add_series(run, series);
  }
  return text::json_text(series) + "\n";
}

std::string comparison_openmetrics(const RunComparison& comparison) {
  std::string text =
      family("run_ok", "1 if the run was neither lost nor failed", comparison, [](const ComparedRun& run) {
        return std::optional<std::string>(
            run.runs.fresh.front().record.status == record::RunStatus::ok ? "1" : "0");
      });
  text +=
      family("failed_gates", "gates of the comparison that failed", comparison, [](const ComparedRun& run) {
        return std::optional(fmt::format("{}", std::ranges::count_if(run.gates, &GateResult::fails)));
      });
  for (const registry::RunMetric* metric : gated_metrics()) {
    text += family(metric->key, help_of(metric->definition, metric->unit), comparison,
                   [&](const ComparedRun& run) {
                     const auto value = registry::number_of(run.runs.fresh.front().record, *metric).value;
                     return value ? std::optional(fmt::format("{:.9g}", *value)) : std::nullopt;
                   });
  }
  for (const registry::RunMetric* cost : gated_costs()) {
    text += family(cost->key, help_of(cost->definition, cost->unit), comparison, [&](const ComparedRun& run) {
      const std::vector<double> numbers = numbers_of(run.runs.fresh.runs, *cost);
      return numbers.empty() ? std::nullopt : std::optional(middle_of(numbers).value);
    });
  }
  return text + "# EOF\n";
}

}  // namespace fusebench::compare
