#include "eval/cli/running/suite_conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "eval/cli/console/console.hpp"
#include "eval/compare/study/criteria_json.hpp"
#include "eval/compare/study/summary_formats.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::running {

namespace {

constexpr int kExitCriterionFailed = 1;

/// With their records.
std::vector<study::StudyRun> study_runs(const engine::BatchPlan& plan,
                                        const std::vector<engine::BatchOutcome>& outcomes) {
  std::vector<study::StudyRun> runs;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const engine::BatchOutcome& outcome = outcomes[i];
    if (outcome.skipped) continue;
    auto record = record::read_record(outcome.folder / "record.json");
    if (!record) {
      record = record::RunRecord{};
      record->reason = outcome.reason;
      record->recording.name = outcome.recording;
      record->variant = outcome.variant;
      record->config_hash = config::config_hash(plan.jobs[i].spec.config.values());
    }
    const bool is_there = record->status != record::RunStatus::failed;
    runs.push_back({outcome.recording, outcome.group, outcome.split, outcome.variant,
                    is_there ? outcome.folder : std::filesystem::path(), std::move(*record)});
  }
  return runs;
}

/// Without the folders of this machine.
std::string command_of(const BenchOptions& options) {
  const engine::Invocation& asked = options.invocation;
  const std::filesystem::path suite =
      asked.suite.is_relative() ? asked.suite : std::filesystem::path(asked.suite.filename());
  std::string command = fmt::format("fusebench bench {} --data DATA", suite.generic_string());
  for (const std::string& only : asked.options.only) command += " --only " + only;
  for (const std::string& set : asked.options.sets) command += " --set " + set;
  if (asked.overrides.replicates > 0) command += fmt::format(" --replicates {}", asked.overrides.replicates);
  return command;
}

}  // namespace

RunCounts counts_of(const std::vector<engine::BatchOutcome>& outcomes) {
  RunCounts counts;
  for (const engine::BatchOutcome& outcome : outcomes) {
    if (outcome.skipped) continue;
    ++counts.total;
    if (outcome.status == record::RunStatus::ok) ++counts.ok;
    if (outcome.status == record::RunStatus::failed) ++counts.failed;
  }
  return counts;
}

Result<std::vector<study::CriterionResult>> conclude(const suites::Suite& suite, const BenchOptions& options,
                                                     const engine::BatchPlan& plan,
                                                     const std::vector<engine::BatchOutcome>& outcomes) {
  const bool files = !options.summary.empty() || !options.summary_page.empty();
  if (suite.criteria.empty() && !files) return std::vector<study::CriterionResult>{};
  const study::Study study = study::gather_study(study_runs(plan, outcomes), suite.variants);
  study::StudySummary summary = study::summarise(suite.name, study, suite.criteria);
  if (!options.summary.empty()) {
    const std::string json = study::summary_json(summary, study, {command_of(options), plan.absent});
    if (auto written = text::write_text_file(options.summary, json); !written)
      return tl::unexpected(written.error());
  }
  if (!options.summary_page.empty()) {
    if (auto written = text::write_text_file(options.summary_page, study::summary_page(summary, study));
        !written)
      return tl::unexpected(written.error());
  }
  if (!options.controls.json) console::print_output(study::summary_text(summary));
  return std::move(summary.criteria);
}

int exit_code_of(const RunCounts& counts, const std::vector<study::CriterionResult>& criteria) {
  const auto failed = [](const study::CriterionResult& criterion) {
    return criterion.decided.verdict == study::Verdict::failed;
  };
  if (std::any_of(criteria.begin(), criteria.end(), failed)) return kExitCriterionFailed;
  const bool good = criteria.empty() ? counts.ok == counts.total : counts.failed == 0;
  return good ? 0 : console::kExitRunFailed;
}

std::string json_of(const suites::Suite& suite, const engine::BatchPlan& plan,
                    const std::vector<engine::BatchOutcome>& outcomes, const RunCounts& counts,
                    const std::vector<study::CriterionResult>& criteria) {
  using Json = nlohmann::ordered_json;
  Json runs = Json::array();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const engine::BatchOutcome& outcome = outcomes[i];
    runs.push_back({{"recording", outcome.recording},
                    {"variant", outcome.variant},
                    {"edits", suites::to_string(plan.jobs[i].edits)},
                    {"repetition", plan.jobs[i].spec.repetition},
                    {"replicate", plan.jobs[i].spec.replicate},
                    {"status", record::to_string(outcome.status)},
                    {"reason", outcome.reason},
                    {"skipped", outcome.skipped},
                    {"resumed", outcome.resumed},
                    {"folder", outcome.folder.string()}});
  }
  Json excluded = Json::array();
  for (const engine::ExcludedRun& run : plan.excluded)
    excluded.push_back({{"run", run.run}, {"reason", run.reason}});
  Json document = {{"suite", suite.name},
                   {"n_ok", counts.ok},
                   {"n_total", counts.total},
                   {"runs", runs},
                   {"excluded", excluded}};
  if (!suite.criteria.empty()) document["criteria"] = study::criteria_json(criteria);
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::cli::running
