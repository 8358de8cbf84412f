#include "eval/suites/engine/plan_preview.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "eval/suites/engine/job_outcome.hpp"
#include "eval/suites/engine/opened_recordings.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::engine {

namespace {

constexpr std::array<std::string_view, 4> kStateNames = {"finished", "failed before", "to do", "unknown"};

std::string_view name_of(JobState state) { return kStateNames[static_cast<std::size_t>(state)]; }

/// Mean times of finished runs.
class KnownTimes {
 public:
  void add(const std::string& key, double time_s) {
    auto& [sum_s, count] = times_[key];
    sum_s += time_s;
    ++count;
  }
  [[nodiscard]] std::optional<double> of(const std::string& key) const {
    const auto found = times_.find(key);
    if (found == times_.end()) return std::nullopt;
    return found->second.first / static_cast<double>(found->second.second);
  }

 private:
  std::map<std::string, std::pair<double, std::size_t>> times_;
};

std::string kind_of(const BatchJob& job) {
  const auto& frames = job.spec.frames;
  return fmt::format("{} {} {}", job.recording.string(), job.variant,
                     frames ? run::to_string(*frames) : "all");
}

struct Seen {
  PlannedRun run;
  std::size_t frames = 0;
};

Seen look_at(const BatchJob& job, OpenedRecordings& opened, KnownTimes& times) {
  Seen seen{{to_string(job), JobState::unknown, "", 0}, 0};
  std::error_code ignored;
  if (job.simulation && !std::filesystem::exists(job.recording, ignored)) {
    seen.run.note = "its recording will be simulated first";
    return seen;
  }
  const auto& recording = opened.of(job.spec);
  if (!recording) {
    seen.run.note = recording.error().message;
    if (was_not_started(job)) seen.run.state = JobState::failed;
    return seen;
  }
  const run::PreparedRun prepared = run::place_run(job.spec, *recording);
  seen.frames = prepared.recording.frames.size();
  const auto head = run::record_head(prepared.folder);
  const bool ours = head && head->run_id == prepared.run_id;
  seen.run.state = ours && is_finished(prepared, *head)                ? JobState::finished
                   : ours && head->status == record::RunStatus::failed ? JobState::failed
                                                                       : JobState::waiting;
  if (seen.run.state != JobState::finished) return seen;
  if (const auto record = record::read_record(prepared.folder / "record.json"))
    times.add(kind_of(job), record->timing.wall_s);
  return seen;
}

std::string summary(const PlanPreview& preview, const BatchPlan& plan, int at_once) {
  std::string text = fmt::format(
      "{} runs: {} finished, {} failed before, {} to do, {} unknown; {} excluded\n", preview.runs.size(),
      preview.finished, preview.failed, preview.waiting, preview.unknown, plan.excluded.size());
  if (preview.finished == preview.runs.size()) return text;
  if (preview.finished + preview.unknown == preview.runs.size())
    return text + "how long they take is known when their recordings are there\n";
  text += fmt::format("about {} of work, {} with {} at a time", text::duration_text(preview.time_s),
                      text::duration_text(preview.time_s / at_once), at_once);
  if (preview.guessed > 0)
    text += fmt::format(" ({} of the runs by a guess of {:.0f} ms a frame: none like them has finished here)",
                        preview.guessed, 1000 * kGuessPerFrame_s);
  if (preview.unknown > 0)
    text += fmt::format("; the estimate excludes {} run{}", preview.unknown, preview.unknown == 1 ? "" : "s");
  return text + "\n";
}

}  // namespace

PlanPreview preview_of(const BatchPlan& plan) {
  PlanPreview preview;
  KnownTimes times;
  OpenedRecordings opened(suites::RunLimits{});
  std::vector<std::size_t> frames;
  for (const BatchJob& job : plan.jobs) {
    Seen seen = look_at(job, opened, times);
    preview.runs.push_back(std::move(seen.run));
    frames.push_back(seen.frames);
  }
  for (std::size_t i = 0; i < preview.runs.size(); ++i) {
    PlannedRun& run = preview.runs[i];
    if (run.state == JobState::finished) ++preview.finished;
    if (run.state == JobState::failed) ++preview.failed;
    if (run.state == JobState::waiting) ++preview.waiting;
    if (run.state == JobState::unknown) ++preview.unknown;
    if (run.state != JobState::waiting && run.state != JobState::failed) continue;
    const auto known = times.of(kind_of(plan.jobs[i]));
    if (!known) ++preview.guessed;
    run.time_s = known.value_or(kGuessPerFrame_s * static_cast<double>(frames[i]));
    preview.time_s += run.time_s;
  }
  return preview;
}

std::string to_text(const PlanPreview& preview, const BatchPlan& plan, int at_once) {
  std::vector<std::vector<std::string>> lines = {{"run", "state", "time", "note"}};
  for (const PlannedRun& run : preview.runs) {
    lines.push_back({run.name, std::string(name_of(run.state)),
                     run.time_s > 0 ? text::duration_text(run.time_s) : "-", run.note});
  }
  for (const ExcludedRun& run : plan.excluded) lines.push_back({run.run, "excluded", "-", run.reason});
  return text::aligned_columns(lines) + "\n" + summary(preview, plan, at_once);
}

std::string to_json(const PlanPreview& preview, const BatchPlan& plan, int at_once) {
  using Json = nlohmann::ordered_json;
  Json runs = Json::array();
  for (const PlannedRun& run : preview.runs)
    runs.push_back(
        {{"run", run.name}, {"state", name_of(run.state)}, {"time_s", run.time_s}, {"note", run.note}});
  Json excluded = Json::array();
  for (const ExcludedRun& run : plan.excluded) excluded.push_back({{"run", run.run}, {"reason", run.reason}});
  const Json document = {{"n_total", preview.runs.size()},
                         {"n_finished", preview.finished},
                         {"n_failed", preview.failed},
                         {"n_to_do", preview.waiting},
                         {"n_unknown", preview.unknown},
                         {"n_guessed", preview.guessed},
                         {"work_s", preview.time_s},
                         {"time_s", preview.time_s / at_once},
                         {"runs", runs},
                         {"excluded", excluded}};
  return text::json_text(document) + "\n";
}

}  // namespace fusebench::engine
