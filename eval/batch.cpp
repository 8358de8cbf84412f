#include "eval/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/staged_folder.hpp"

namespace fusebench {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kNotStarted = "not-started";

/// A recording of the suite with what its jobs need to know.
struct Planned {
  fs::path folder;
  std::string group;
  std::string half;
  std::vector<std::string> variants;
  std::optional<SimulationRequest> simulation = {};
};

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

/// Whether --only can leave something of a recording that the suite calls by that name ("begin*" as well).
bool may_be_wanted(const std::vector<std::string>& only, std::string_view name) {
  if (name.ends_with('*')) name.remove_suffix(1);
  return std::all_of(only.begin(), only.end(), [&](const std::string& filter) {
    constexpr std::string_view key = "recording=";
    return !filter.starts_with(key) || name.find(filter.substr(key.size())) != std::string_view::npos;
  });
}

Result<std::vector<Planned>> existing_recordings(const Suite& suite, const BatchOptions& options) {
  std::vector<Planned> planned;
  if (suite.all) {
    if (options.data.empty()) {
      return fail(ErrorCode::data_missing,
                  fmt::format("suite '{}' runs over all recordings, and no folder is given", suite.name),
                  "--data or FUSEBENCH_DATA names the folder of recordings");
    }
    const auto folders = recordings_under(options.data);
    if (!folders) return tl::unexpected(folders.error());
    for (const fs::path& folder : *folders) {
      planned.push_back({folder, folder.filename().string(), std::string(kHeldOutHalf), suite.variants});
    }
  }
  for (const SuiteRecording& recording : suite.recordings) {
    const auto folders = find_recordings(recording.name, options.data);
    if (!folders) {
      if (!may_be_wanted(options.only, recording.name)) continue;
      return tl::unexpected(folders.error());
    }
    for (const fs::path& folder : *folders) {
      planned.push_back({folder, recording.group.empty() ? folder.filename().string() : recording.group,
                         recording.half, recording.variants.empty() ? suite.variants : recording.variants});
    }
  }
  return planned;
}

Result<Planned> simulated_recording(const SuiteSimulation& simulation, const BatchOptions& options) {
  SimulationRequest request = simulation.request;
  if (!request.trajectory.empty() && request.trajectory.is_relative()) {
    if (options.data.empty()) {
      return fail(ErrorCode::data_missing,
                  fmt::format("{}: the trajectory {} is under --data, which is not given", simulation.place,
                              request.trajectory.string()),
                  "--data or FUSEBENCH_DATA names the folder of recordings");
    }
    request.trajectory = options.data / request.trajectory;
  }
  return Planned{options.simulated / simulation.name, simulation.group, simulation.half, simulation.variants,
                 std::move(request)};
}

Result<std::vector<Planned>> recordings_of(const Suite& suite, const BatchOptions& options) {
  auto planned = existing_recordings(suite, options);
  if (!planned) return planned;
  for (const SuiteSimulation& simulation : suite.simulations) {
    if (!may_be_wanted(options.only, simulation.name)) continue;
    auto recording = simulated_recording(simulation, options);
    if (!recording) return tl::unexpected(recording.error());
    planned->push_back(std::move(*recording));
  }
  // Runs go by the names of recordings: two of one name would overwrite each other's.
  std::set<std::string> names;
  for (const Planned& recording : *planned) {
    const std::string name = recording.folder.filename().string();
    if (names.insert(name).second || suite.all) continue;
    return fail(ErrorCode::configuration,
                fmt::format("suite '{}' has two recordings of the name '{}'", suite.name, name));
  }
  return planned;
}

Result<BatchJob> job_of(const Suite& suite, const BatchOptions& options, const Planned& recording,
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
  spec.recording = recording.folder;
  spec.imu = suite.imu;
  spec.variant = variant_name;
  spec.config = std::move(*config);
  spec.threads = options.threads;
  spec.out = options.out;
  const bool optional = suite.all && !recording.simulation;
  return BatchJob{recording.folder, variant_name,   std::move(spec),     optional,
                  recording.group,  recording.half, recording.simulation};
}

BatchOutcome run_job(const BatchJob& job, bool resume, const BatchControl& control) {
  const auto run = prepare_run(job.spec);
  if (!run) {
    if (!job.optional || run.error().code != ErrorCode::configuration)
      return not_started(job, run.error().message);
    BatchOutcome outcome = without_results(job, run.error().message);
    outcome.skipped = true;
    return outcome;
  }
  BatchOutcome outcome = without_results(job, "");
  std::error_code ignored;
  fs::remove_all(run->folder.parent_path() / kNotStarted, ignored);
  if (resume) {
    auto existing = read_record(run->folder / "record.json");
    outcome.resumed = existing && existing->status != RunStatus::failed;
    if (outcome.resumed) outcome.record = std::move(*existing);
  }
  if (!outcome.resumed) {
    auto record = execute_run(*run, {control.progress, control.stop});
    if (!record) {
      // What lies in the run's folder then is of an earlier run.
      const bool stopped = control.stop != nullptr && control.stop->load();
      return stopped ? without_results(job, record.error().message)
                     : not_started(job, record.error().message);
    }
    outcome.record = std::move(*record);
  }
  outcome.folder = run->folder;
  outcome.status = outcome.record.status;
  outcome.reason = outcome.record.reason;
  return outcome;
}

}  // namespace

Result<std::vector<BatchJob>> plan_batch(const Suite& suite, const BatchOptions& options) {
  const auto recordings = recordings_of(suite, options);
  if (!recordings) return tl::unexpected(recordings.error());
  std::vector<BatchJob> jobs;
  for (const Planned& recording : *recordings) {
    for (const std::string& variant : recording.variants) {
      const auto take = wanted(options.only, recording.folder.filename().string(), variant);
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

BatchOutcome without_results(const BatchJob& job, std::string reason) {
  BatchOutcome outcome;
  outcome.recording = job.recording.filename().string();
  outcome.variant = job.variant;
  outcome.group = job.group;
  outcome.half = job.half;
  outcome.reason = std::move(reason);
  outcome.record.reason = outcome.reason;
  outcome.record.recording.name = outcome.recording;
  outcome.record.variant = outcome.variant;
  outcome.record.config_hash = config_hash(job.spec.config.values);
  return outcome;
}

BatchOutcome not_started(const BatchJob& job, std::string reason) {
  BatchOutcome outcome = without_results(job, std::move(reason));
  // If even this cannot be written the outcome still says what happened.
  auto folder = StagedFolder::create(job.spec.out / outcome.recording / outcome.variant / kNotStarted);
  if (folder && folder->write("record.json", to_json(outcome.record))) static_cast<void>(folder->commit());
  return outcome;
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
