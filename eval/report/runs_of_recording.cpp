#include "eval/report/runs_of_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "eval/record/data_labels.hpp"
#include "eval/record/run_files/run_set.hpp"

namespace fusebench::report {

namespace {

/// A run that failed before it knew the recording's content has no fingerprint.
bool is_same_recording(const record::RecordedRecording& a, const record::RecordedRecording& b) {
  if (a.name != b.name) return false;
  return a.fingerprint == b.fingerprint || a.fingerprint.empty() || b.fingerprint.empty();
}

}  // namespace

std::vector<RunsOfRecording> runs_by_recording(const std::vector<run_files::FoundRun>& runs) {
  std::vector<RunsOfRecording> groups;
  for (std::size_t begin = 0; begin < runs.size();) {
    std::size_t end = begin + 1;
    while (end < runs.size() && is_same_recording(runs[end - 1].record.recording, runs[end].record.recording))
      ++end;
    groups.emplace_back(runs.data() + begin, end - begin);
    begin = end;
  }
  return groups;
}

std::size_t place_of(const run_files::FoundRun& run, RunsOfRecording group) {
  return static_cast<std::size_t>(std::ranges::find(group, run.folder, &run_files::FoundRun::folder) -
                                  group.begin());
}

std::string title_of(const record::RecordedRecording& recording,
                     const std::vector<run_files::FoundRun>& runs) {
  const std::vector<std::string> windows = run_files::RunSet(runs).window_labels();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const record::RecordedRecording& other = runs[i].record.recording;
    const bool same = other.name == recording.name && other.first_frame == recording.first_frame &&
                      other.frames == recording.frames;
    if (same && recording.frames > 0 && !windows[i].empty())
      return fmt::format("{}, {}", recording.name, windows[i]);
  }
  return recording.name;
}

std::string facts_of(const record::RecordedRecording& recording) {
  const std::string data = record::data_cell(record::words_of(recording));
  constexpr std::string_view kRecorded = "recorded";
  return fmt::format("{}, format {}, {} frames{} over {:.1f} s; ground truth: {}.",
                     data.starts_with(kRecorded) ? "real" + data.substr(kRecorded.size()) : data,
                     recording.format, recording.frames,
                     recording.whole_frames > 0 ? fmt::format(" of {}", recording.whole_frames) : "",
                     recording.duration_s, recording.truth.empty() ? "unknown" : recording.truth);
}

page::PageTable run_facts(RunsOfRecording group, const RunLabels& labels) {
  page::PageTable table;
  const bool reasons =
      std::ranges::any_of(group, [](const run_files::FoundRun& r) { return !r.record.reason.empty(); });
  const bool segments =
      std::ranges::any_of(group, [](const run_files::FoundRun& r) { return r.record.frames.segments > 0; });
  table.header = {"run", "status", "tracked", "lost", "IMU"};
  if (segments) table.header.emplace_back("tracked apart from the map");
  if (reasons) table.header.emplace_back("reason");
  for (std::size_t i = 0; i < group.size(); ++i) {
    const record::RunRecord& r = group[i].record;
    table.rows.push_back(
        {{labels[i], record::status_text(r.status, r.metrics.silent_frames()),
          fmt::format("{}/{}", r.frames.tracked, r.frames.total), fmt::format("{}", r.frames.lost),
          r.recording.imu},
         r.status == record::RunStatus::ok && r.metrics.silent_frames().value_or(0) == 0 ? "" : "warning"});
    if (segments) table.rows.back().cells.push_back(record::segments_text(r.frames));
    if (reasons) table.rows.back().cells.push_back(r.reason);
  }
  return table;
}

std::vector<run_files::FoundRun> runs_to_draw(RunsOfRecording group) {
  std::vector<run_files::FoundRun> runs(group.begin(), group.end());
  if (runs.size() <= kMostDrawn) return runs;
  std::ranges::stable_sort(runs, {}, [](const run_files::FoundRun& run) {
    const auto& ate = run.record.metrics.ate.value;
    return ate && run.record.status == record::RunStatus::ok ? ate->stats.rmse
                                                             : std::numeric_limits<double>::infinity();
  });
  runs.resize(kMostDrawn);
  return runs;
}

}  // namespace fusebench::report
