#include "eval/report/results_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "eval/page/series_colours.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "eval/report/recording_sections.hpp"
#include "eval/report/runs_of_recording.hpp"
#include "eval/report/speed_failures/speed_sections.hpp"
#include "eval/report/summary_sections.hpp"

namespace fusebench::report {

namespace {

PageDetail detail_for(std::size_t runs, std::size_t recordings) {
  constexpr std::size_t kBuckets = 12'000;  // of all runs together
  constexpr std::size_t kTriangles = 400'000;
  constexpr std::size_t kImages = 100;
  constexpr double kPicturePixels = 2e6;
  const std::size_t share = std::max<std::size_t>(runs, 1);
  return {std::clamp<std::size_t>(kBuckets / share, 40, 450),
          std::clamp<std::size_t>(kTriangles / share, 1'500, 40'000),
          std::min<std::size_t>(kImages / std::max<std::size_t>(recordings, 1), 16),
          std::clamp(static_cast<int>(std::sqrt(kPicturePixels / static_cast<double>(share))), 200, 800)};
}

std::vector<std::size_t> colours_of(const std::vector<run_files::FoundRun>& runs,
                                    const std::vector<std::string>& methods) {
  std::vector<page::ColouredName> names;
  for (std::size_t i = 0; i < runs.size(); ++i)
    names.push_back({methods[i], run_files::variant_rank(runs[i].record.variant)});
  return page::series_colours(names);
}

/// Each recording has some twenty charts, and a sweep has charts above them: the last ones would be far
/// below.
bool has_many_charts(std::size_t recordings, const std::vector<std::string>& methods) {
  constexpr std::size_t kMostOpenRecordings = 2;
  constexpr std::size_t kMostOpenMethods = 6;
  return recordings > kMostOpenRecordings ||
         std::set(methods.begin(), methods.end()).size() > kMostOpenMethods;
}

}  // namespace

ResultsPage results_page(const std::vector<run_files::FoundRun>& runs, const std::string& title,
                         const FrameReader& reader, const PictureWriter& writer) {
  ResultsPage result;
  const auto ok = std::ranges::count_if(
      runs, [](const run_files::FoundRun& run) { return run.record.status == record::RunStatus::ok; });
  result.page.title = title;
  result.page.subtitle = fmt::format("{} of {} runs ok.", ok, runs.size());
  const std::vector<RunsOfRecording> groups = runs_by_recording(runs);
  std::size_t drawn = 0;
  for (const RunsOfRecording group : groups) drawn += std::min(group.size(), kMostDrawn);
  const std::vector<std::string> methods = run_files::RunSet(runs).methods();
  std::vector<std::string> pictures(runs.size());
  const PageContext context{
      runs, methods, colours_of(runs, methods), detail_for(drawn, groups.size()), reader, writer, pictures};
  speed_failures::FailureSections failures;
  const bool folded = has_many_charts(groups.size(), methods);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    RecordingSections recording = recording_sections(groups[i], context, failures);
    if (folded && !recording.sections.empty()) recording.sections.front().folded = true;
    std::ranges::move(recording.sections, std::back_inserter(result.page.sections));
    std::ranges::move(recording.warnings, std::back_inserter(result.warnings));
  }
  std::vector<page::PageSection> tables = summary_sections(runs, pictures);
  std::ranges::move(failures.sections(), std::back_inserter(tables));
  result.tables = tables.size();
  result.page.sections.insert(result.page.sections.begin(), std::make_move_iterator(tables.begin()),
                              std::make_move_iterator(tables.end()));
  return result;
}

}  // namespace fusebench::report
