#include "eval/batch.hpp"

#include <fmt/format.h>

#include <string_view>
#include <system_error>

#include "core/staged_folder.hpp"

namespace fusebench {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kNotStarted = "not-started";

Result<std::vector<fs::path>> recordings_of(const Suite& suite, const BatchOptions& options) {
  if (suite.all) {
    if (options.data.empty()) {
      return fail(ErrorCode::data_missing,
                  fmt::format("suite '{}' runs over all recordings, and no folder is given", suite.name),
                  "--data or FUSEBENCH_DATA names the folder of recordings");
    }
    return recordings_under(options.data);
  }
  std::vector<fs::path> folders;
  for (const std::string& name : suite.recordings) {
    auto folder = find_recording(name, options.data);
    if (!folder) return tl::unexpected(folder.error());
    folders.push_back(std::move(*folder));
  }
  return folders;
}

/// Whether a job is among those asked for.
Result<bool> wanted(const std::vector<std::string>& only, const std::string& recording,
                    const std::string& variant) {
  for (const std::string& filter : only) {
    const auto equals = filter.find('=');
    const std::string key = filter.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : filter.substr(equals + 1);
    if ((key != "recording" && key != "variant") || value.empty()) {
      return fail(ErrorCode::usage,
                  fmt::format("--only {} (allowed: recording=TEXT | variant=NAME)", filter));
    }
    if (key == "recording" && recording.find(value) == std::string::npos) return false;
    if (key == "variant" && variant != value) return false;
  }
  return true;
}

Result<BatchJob> job_of(const Suite& suite, const BatchOptions& options, const fs::path& recording,
                        const std::string& variant_name) {
  const auto variant = find_variant(variant_name);
  if (!variant) return tl::unexpected(variant.error());
  auto config = suite_config(suite, *variant);
  if (!config) return tl::unexpected(config.error());
  for (const std::string& assignment : options.sets) {
    if (auto set = config->set_assignment(assignment); !set) return tl::unexpected(set.error());
  }
  if (auto related = check_relations(config->values); !related) return tl::unexpected(related.error());
  RunSpec spec;
  spec.recording = recording;
  spec.imu = suite.imu;
  spec.variant = variant_name;
  spec.config = std::move(*config);
  spec.threads = options.threads;
  spec.out = options.out;
  return BatchJob{recording, variant_name, std::move(spec), suite.all};
}

/// A run that could not start still has to appear in tables: a record that says so, in the place of a run.
void record_not_started(const BatchJob& job, const BatchOutcome& outcome) {
  RunRecord record;
  record.reason = outcome.reason;
  record.recording.name = outcome.recording;
  record.variant = outcome.variant;
  record.config_hash = config_hash(job.spec.config.values);
  // If even this cannot be written the outcome still says what happened.
  auto folder = StagedFolder::create(job.spec.out / outcome.recording / outcome.variant / kNotStarted);
  if (folder && folder->write("record.json", to_json(record))) static_cast<void>(folder->commit());
}

BatchOutcome run_job(const BatchJob& job, bool resume, const BatchControl& control) {
  BatchOutcome outcome;
  outcome.recording = job.recording.filename().string();
  outcome.variant = job.variant;
  const auto run = prepare_run(job.spec);
  if (!run) {
    outcome.reason = run.error().message;
    outcome.skipped = job.optional && run.error().code == ErrorCode::configuration;
    if (!outcome.skipped) record_not_started(job, outcome);
    return outcome;
  }
  std::error_code ignored;
  fs::remove_all(run->folder.parent_path() / kNotStarted, ignored);
  outcome.folder = run->folder;
  if (resume) {
    auto existing = read_record(run->folder / "record.json");
    outcome.resumed = existing && existing->status != RunStatus::failed;
    if (outcome.resumed) outcome.record = std::move(*existing);
  }
  if (!outcome.resumed) {
    auto record = execute_run(*run, {control.progress, control.stop});
    if (!record) {
      outcome.reason = record.error().message;
      return outcome;
    }
    outcome.record = std::move(*record);
  }
  outcome.status = outcome.record.status;
  outcome.reason = outcome.record.reason;
  return outcome;
}

}  // namespace

Result<std::vector<BatchJob>> plan_batch(const Suite& suite, const BatchOptions& options) {
  const auto recordings = recordings_of(suite, options);
  if (!recordings) return tl::unexpected(recordings.error());
  std::vector<BatchJob> jobs;
  for (const fs::path& recording : *recordings) {
    for (const std::string& variant : suite.variants) {
      const auto take = wanted(options.only, recording.filename().string(), variant);
      if (!take) return tl::unexpected(take.error());
      if (!*take) continue;
      auto job = job_of(suite, options, recording, variant);
      if (!job) return tl::unexpected(job.error());
      jobs.push_back(std::move(*job));
    }
  }
  if (jobs.empty()) {
    return fail(ErrorCode::usage, fmt::format("--only leaves nothing of suite '{}'", suite.name),
                "recording=TEXT keeps the recordings whose name contains it, variant=NAME one variant");
  }
  return jobs;
}

Result<std::vector<BatchOutcome>> run_batch(const std::vector<BatchJob>& jobs, bool resume,
                                            const BatchControl& control) {
  std::vector<BatchOutcome> outcomes;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (control.started) control.started(jobs[i], i, jobs.size());
    BatchOutcome outcome = run_job(jobs[i], resume, control);
    if (control.stop != nullptr && control.stop->load())
      return fail(ErrorCode::run_failed, "stopped by the user");
    if (control.finished) control.finished(outcome);
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

}  // namespace fusebench
