#include "eval/suites/engine/job_outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/io/staged_folder.hpp"
#include "core/config/config_access.hpp"
#include "eval/record/profile/trace_file.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/run/run_specification.hpp"

namespace fusebench::engine {

namespace {

namespace fs = std::filesystem;

fs::path not_started_folder(const BatchJob& job) {
  std::string name = "not-started-" + config::config_hash(job.spec.config.values()).substr(0, 8);
  if (job.spec.frames) {
    name += fmt::format("-{}", job.spec.frames->begin);
    if (job.spec.frames->end) name += fmt::format("-{}", *job.spec.frames->end);
  }
  if (job.spec.repetition > 1) name += fmt::format("-r{}", job.spec.repetition);
  if (job.spec.replicate > 0) name += fmt::format("-k{}", job.spec.replicate);
  return job.spec.out / job.recording.filename() / job.variant / name;
}

/// Of KeptFiles::small, without the profile.
bool is_kept_of_small(const std::string& name) {
  constexpr std::array<std::string_view, 5> kSmall = {"trajectory.tum", "truth.tum", "frames.csv", "nees.csv",
                                                      "log.txt"};
  return std::ranges::find(kSmall, name) != kSmall.end();
}

std::string reason_of(const process::JobEnd& end) { return end.error ? end.error->message : end.reason; }

}  // namespace

BatchOutcome outcome_without_results(const BatchJob& job, std::string reason) {
  BatchOutcome outcome;
  outcome.recording = job.recording.filename().string();
  outcome.variant = job.variant;
  outcome.group = job.group;
  outcome.split = job.split;
  outcome.reason = std::move(reason);
  return outcome;
}

Result<BatchOutcome> record_not_started(const BatchJob& job, std::string reason) {
  BatchOutcome outcome = outcome_without_results(job, std::move(reason));
  record::RunRecord record;
  record.reason = outcome.reason;
  record.recording.name = outcome.recording;
  record.variant = outcome.variant;
  record.repetition = job.spec.repetition;
  record.replicate = job.spec.replicate;
  if (job.simulation) record.recording.data = "simulated";
  if (job.spec.frames) {
    record.recording.first_frame = job.spec.frames->begin;
    if (job.spec.frames->end) record.recording.frames = *job.spec.frames->end - job.spec.frames->begin;
  }
  record.config_hash = config::config_hash(job.spec.config.values());
  outcome.folder = not_started_folder(job);
  auto folder = io::StagedFolder::create(outcome.folder);
  if (!folder) return tl::unexpected(folder.error());
  if (auto done = run_files::commit_run(*folder, record); !done) return tl::unexpected(done.error());
  return outcome;
}

bool was_not_started(const BatchJob& job) {
  std::error_code ignored;
  return fs::exists(not_started_folder(job), ignored);
}

bool is_finished(const run::PreparedRun& run, const run::RecordHead& head) {
  if (head.status == record::RunStatus::failed || head.run_id != run.run_id) return false;
  const bool lacks_one = std::ranges::any_of(head.missing, [&](const std::string& name) {
    return name != profile::kTraceFile && (run.spec.kept == run::KeptFiles::all || is_kept_of_small(name));
  });
  if (lacks_one) return false;
  std::error_code ignored;
  if (run.spec.profile && !fs::exists(run.folder / profile::kTraceFile, ignored)) return false;
  if (run.spec.kept == run::KeptFiles::small) return true;
  // What a run of small files does not keep: pixels, or of a system without patches its model.
  const bool has_patches = run::runs_filter(run.spec);
  if (has_patches) return fs::exists(run.folder / "intensity.bin", ignored);
  return !head.has_model || fs::exists(run.folder / "mesh.ply", ignored);
}

void forget_not_started(const BatchJob& job) {
  std::error_code ignored;
  fs::remove_all(not_started_folder(job), ignored);
}

Result<BatchOutcome> record_failed(const BatchJob& job, const run::PreparedRun& run,
                                   const process::JobEnd& end) {
  BatchOutcome outcome = outcome_without_results(job, reason_of(end));
  const auto there = run::record_head(run.folder);
  if (there && there->status != record::RunStatus::failed && there->run_id == run.run_id) return outcome;
  record::RunRecord record = run::requested_record(run);
  record.reason = outcome.reason;
  record.frames.total = run.recording.frames.size();
  record.timing.cpu_s = end.cpu_s;
  record.timing.wall_s = end.wall_s;
  record.timing.peak_rss_bytes = end.peak_rss_bytes;
  outcome.folder = run.folder;
  auto folder = io::StagedFolder::create(run.folder);
  if (!folder) return tl::unexpected(folder.error());
  const std::string log =
      fmt::format("{}{}failed: {}\n", end.output,
                  end.output.empty() || end.output.ends_with('\n') ? "" : "\n", outcome.reason);
  if (auto written = folder->write("log.txt", log); !written) return tl::unexpected(written.error());
  // What the process printed may depend on when it was ended.
  if (auto done = run_files::commit_run(*folder, record, "log.txt"); !done)
    return tl::unexpected(done.error());
  return outcome;
}

BatchOutcome outcome_of_finished(const BatchJob& job, const fs::path& folder, const run::RecordHead& head) {
  BatchOutcome outcome = outcome_without_results(job, head.reason);
  outcome.status = head.status;
  outcome.folder = folder;
  return outcome;
}

}  // namespace fusebench::engine
