// The runs of one recording, of those that a page shows: what they are of, and which are drawn.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::report {

using RunsOfRecording = std::span<const run_files::FoundRun>;
using RunLabels = std::vector<std::string>;  ///< one a run of a recording

/// Of runs that are sorted by their recordings, with the same window of it.
[[nodiscard]] std::vector<RunsOfRecording> runs_by_recording(const std::vector<run_files::FoundRun>& runs);

/// Which of a recording's runs it is.
[[nodiscard]] std::size_t place_of(const run_files::FoundRun& run, RunsOfRecording group);

/// The recording's name, with the window of runs that processed a part of it (RunSet::window_labels()).
[[nodiscard]] std::string title_of(const record::RecordedRecording& recording,
                                   const std::vector<run_files::FoundRun>& runs);
[[nodiscard]] std::string facts_of(const record::RecordedRecording& recording);
[[nodiscard]] page::PageTable run_facts(RunsOfRecording group, const RunLabels& labels);

/// Of a recording: more curves nobody can tell apart.
inline constexpr std::size_t kMostDrawn = 12;
/// All of its runs, or those with the smallest ATE.
[[nodiscard]] std::vector<run_files::FoundRun> runs_to_draw(RunsOfRecording group);

}  // namespace fusebench::report
