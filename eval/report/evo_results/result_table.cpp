#include "eval/report/evo_results/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "eval/report/evo_results/result_archive.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::evo_results {

namespace {

/// In the order of pandas, which evo prints them with.
constexpr std::array<const char*, 7> kColumns = {"max", "mean", "median", "min", "rmse", "sse", "std"};

std::optional<double> statistic_of(const EvoResult& result, std::string_view name) {
  const auto found = std::ranges::find(result.stats, name, [](const auto& entry) { return entry.first; });
  if (found == result.stats.end()) return std::nullopt;
  return found->second;
}

std::string quoted_lines(std::string title) {
  std::ranges::replace(title, '\n', ' ');
  return "'" + title + "'";
}

Result<void> check_titles(const std::vector<LabelledResult>& results,
                          const std::vector<std::filesystem::path>& files) {
  for (std::size_t i = 1; i < results.size(); ++i) {
    if (results[i].result.title == results[0].result.title) continue;
    return fail(
        ErrorCode::usage,
        fmt::format("{} is {}, but {} is {}", files[i].string(), quoted_lines(results[i].result.title),
                    files[0].string(), quoted_lines(results[0].result.title)),
        "--ignore_title puts them side by side all the same");
  }
  return {};
}

Result<void> check_labels(const std::vector<LabelledResult>& results) {
  std::set<std::string> labels;
  for (const LabelledResult& entry : results) {
    if (labels.insert(entry.label).second) continue;
    return fail(ErrorCode::usage, fmt::format("two results are of an estimate '{}'", entry.label),
                "--use_filenames names them by their archives");
  }
  return {};
}

/// Sums of the values at one place, or all values one after the other.
void take(NpyArray& sum, const NpyArray& more, bool add) {
  if (!add) {
    sum.values.insert(sum.values.end(), more.values.begin(), more.values.end());
    sum.shape = {sum.values.size()};
    return;
  }
  for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += more.values[i];
}

/// As merge_results() of evo/core/result.py.
Result<LabelledResult> merged(const std::vector<LabelledResult>& results) {
  LabelledResult all = results.front();
  const auto count = static_cast<double>(results.size());
  bool same_sizes = true;
  for (const LabelledResult& entry : results) {
    for (const auto& [name, array] : all.result.arrays) {
      const NpyArray* const other = entry.result.array(name);
      if (other == nullptr || entry.result.arrays.size() != all.result.arrays.size())
        return fail(
            ErrorCode::usage,
            fmt::format("{} and {} do not keep the same arrays ({})", results[0].label, entry.label, name),
            "--merge takes results of one kind");
      same_sizes = same_sizes && other->values.size() == array.values.size();
    }
    for (const auto& [name, value] : all.result.stats) {
      if (!statistic_of(entry.result, name))
        return fail(ErrorCode::usage, fmt::format("{} has no {}", entry.label, name),
                    "--merge takes results of one kind");
    }
  }
  for (std::size_t i = 1; i < results.size(); ++i) {
    for (auto& [name, value] : all.result.stats) value += *statistic_of(results[i].result, name);
    for (auto& [name, array] : all.result.arrays) take(array, *results[i].result.array(name), same_sizes);
  }
  for (auto& [name, value] : all.result.stats) value /= count;
  if (same_sizes) {
    for (auto& [name, array] : all.result.arrays)
      for (double& value : array.values) value /= count;
  }
  return all;
}

}  // namespace

Result<std::vector<LabelledResult>> load_results(const std::vector<std::filesystem::path>& files,
                                                 const ResultChoice& choice) {
  std::vector<LabelledResult> results;
  for (const std::filesystem::path& file : files) {
    auto result = read_result(file);
    if (!result) return tl::unexpected(result.error());
    std::string label = std::filesystem::path(result->estimate_name).filename().string();
    if (choice.use_filenames) label = file.string();
    if (label.empty()) label = "unnamed_result";
    results.push_back({std::move(label), std::move(*result)});
  }
  if (!choice.ignore_title) {
    if (auto same = check_titles(results, files); !same) return tl::unexpected(same.error());
  }
  if (choice.merge) {
    auto all = merged(results);
    if (!all) return tl::unexpected(all.error());
    return std::vector<LabelledResult>{std::move(*all)};
  }
  if (auto unique = check_labels(results); !unique) return tl::unexpected(unique.error());
  return results;
}

std::string to_text(const std::vector<LabelledResult>& results, bool with_title) {
  std::vector<std::vector<std::string>> lines = {{""}};
  for (const char* name : kColumns) lines[0].emplace_back(name);
  lines[0].emplace_back("errors");
  for (const LabelledResult& entry : results) {
    lines.push_back({entry.label});
    for (const char* name : kColumns) {
      const auto value = statistic_of(entry.result, name);
      lines.back().push_back(value ? text::seven_digits(*value) : "-");
    }
    lines.back().push_back(fmt::format("{}", entry.result.array("error_array")->values.size()));
  }
  return (with_title ? results.front().result.title + "\n\n" : "") + text::aligned_columns(lines);
}

std::string to_csv(const std::vector<LabelledResult>& results) {
  std::string csv;
  for (const char* name : kColumns) csv += fmt::format(",{}", name);
  csv += '\n';
  for (const LabelledResult& entry : results) {
    csv += text::csv_cell(entry.label);
    for (const char* name : kColumns) {
      const auto value = statistic_of(entry.result, name);
      csv += value ? fmt::format(",{}", *value) : ",";
    }
    csv += '\n';
  }
  return csv;
}

std::string to_json(const std::vector<LabelledResult>& results) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const LabelledResult& entry : results) {
    nlohmann::ordered_json stats = nlohmann::ordered_json::object();
    for (const auto& [name, value] : entry.result.stats) stats[name] = value;
    rows.push_back({{"label", entry.label},
                    {"title", entry.result.title},
                    {"reference", entry.result.reference_name},
                    {"estimate", entry.result.estimate_name},
                    {"errors", entry.result.array("error_array")->values.size()},
                    {"stats", std::move(stats)}});
  }
  return text::json_text(rows) + "\n";
}

}  // namespace fusebench::evo_results
