#include "eval/report/results_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "eval/page/image_source.hpp"
#include "eval/page/series_colours.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/report/loop_sections.hpp"
#include "eval/report/model_scene.hpp"
#include "eval/report/patch_pictures.hpp"
#include "eval/report/summary_sections.hpp"
#include "eval/run_charts/profile_charts.hpp"
#include "eval/run_charts/run_charts.hpp"
#include "eval/run_charts/run_series.hpp"
#include "eval/run_files/record_files.hpp"
#include "eval/run_files/run_labels.hpp"
#include "eval/speed_failures/speed_sections.hpp"

namespace fusebench::report {

namespace {

constexpr std::size_t kMostDrawn = 12;    // of a recording: more curves nobody can tell apart
constexpr std::size_t kMostPictured = 2;  // variants whose patches stand beside each other

/// How much of each run a page of so many runs shows.
struct Detail {
  std::size_t buckets = 0;     ///< of charts over time
  std::size_t triangles = 0;   ///< of a mesh
  std::size_t in_between = 0;  ///< images of a recording for its time line
};

Detail detail_for(std::size_t runs, std::size_t recordings) {
  constexpr std::size_t kBuckets = 12'000;  // of all runs together
  constexpr std::size_t kTriangles = 400'000;
  constexpr std::size_t kImages = 100;
  const std::size_t share = std::max<std::size_t>(runs, 1);
  return {std::clamp<std::size_t>(kBuckets / share, 40, 450),
          std::clamp<std::size_t>(kTriangles / share, 1'500, 40'000),
          std::min<std::size_t>(kImages / std::max<std::size_t>(recordings, 1), 16)};
}

/// The runs of one recording.
using Group = std::span<const run_files::FoundRun>;

/// A run that failed before it knew the recording's content has no fingerprint.
bool is_same_recording(const record::RecordedRecording& a, const record::RecordedRecording& b) {
  if (a.name != b.name) return false;
  return a.fingerprint == b.fingerprint || a.fingerprint.empty() || b.fingerprint.empty();
}

std::vector<Group> groups_of(const std::vector<run_files::FoundRun>& runs) {
  std::vector<Group> groups;
  for (std::size_t begin = 0; begin < runs.size();) {
    std::size_t end = begin + 1;
    while (end < runs.size() && is_same_recording(runs[end - 1].record.recording, runs[end].record.recording))
      ++end;
    groups.emplace_back(runs.data() + begin, end - begin);
    begin = end;
  }
  return groups;
}

using Labels = std::vector<std::string>;  // one a run of a group

std::size_t place_of(const run_files::FoundRun& run, Group group) {
  return static_cast<std::size_t>(std::ranges::find(group, run.folder, &run_files::FoundRun::folder) -
                                  group.begin());
}

/// The recording's name, with the window where others of it have sections of their own.
std::string title_of(const record::RecordedRecording& recording,
                     const std::vector<run_files::FoundRun>& runs) {
  const bool other_window = std::ranges::any_of(runs, [&](const run_files::FoundRun& run) {
    const record::RecordedRecording& other = run.record.recording;
    return other.name == recording.name && other.frames > 0 &&
           (other.first_frame != recording.first_frame || other.frames != recording.frames);
  });
  if (!other_window || recording.frames == 0) return recording.name;
  return fmt::format("{}, frames {}:{}", recording.name, recording.first_frame,
                     recording.first_frame + recording.frames);
}

std::string facts_of(const record::RecordedRecording& recording) {
  return fmt::format("{}, format {}, {} frames over {:.1f} s; ground truth: {}.",
                     record::data_cell(record::words_of(recording)), recording.format, recording.frames,
                     recording.duration_s, recording.truth.empty() ? "unknown" : recording.truth);
}

page::PageTable run_facts(Group group, const Labels& labels) {
  page::PageTable table;
  const bool reasons =
      std::ranges::any_of(group, [](const run_files::FoundRun& r) { return !r.record.reason.empty(); });
  table.header = {"run", "status", "tracked", "lost", "IMU"};
  if (reasons) table.header.emplace_back("reason");
  for (std::size_t i = 0; i < group.size(); ++i) {
    const record::RunRecord& r = group[i].record;
    table.rows.push_back(
        {{labels[i], record::status_text(r.status, r.metrics.silent_frames()),
          fmt::format("{}/{}", r.frames.tracked, r.frames.total), fmt::format("{}", r.frames.lost),
          r.recording.imu},
         r.status == record::RunStatus::ok && r.metrics.silent_frames().value_or(0) == 0 ? "" : "warning"});
    if (reasons) table.rows.back().cells.push_back(r.reason);
  }
  return table;
}

/// time_s: of the frame that they are of, where it is known.
std::vector<page::PageImage> page_images(const PatchPictures& pictures, std::optional<double> time_s) {
  std::vector<page::PageImage> result;
  for (const PatchPicture& picture : pictures.pictures) {
    constexpr int kQuality = 92;
    result.push_back({picture.caption(), page::jpeg_source(picture.strip, kQuality), time_s});
  }
  return result;
}

/// Of the first variants that kept their patches.
std::vector<LabelledPatches> patches_of(Group drawn, Group group, const Labels& labels,
                                        std::vector<std::string>& warnings) {
  std::vector<LabelledPatches> runs;
  std::vector<std::string> variants;
  for (const run_files::FoundRun& run : drawn) {
    if (runs.size() == kMostPictured) break;
    if (run.state != run_files::RunState::whole) continue;
    if (std::ranges::find(variants, run.record.variant) != variants.end()) continue;
    std::error_code ignored;
    const bool is_there = std::filesystem::exists(run.folder / "patches.csv", ignored);
    const auto checked =
        is_there ? run_files::check_file(run.folder, run.record, "patches.csv") : Result<void>();
    auto frames = checked ? run_files::read_patch_table(run.folder) : tl::unexpected(checked.error());
    if (!frames) warnings.push_back(frames.error().message);
    if (!frames || frames->empty()) continue;
    runs.push_back({labels[place_of(run, group)], std::move(*frames)});
    variants.push_back(run.record.variant);
  }
  return runs;
}

std::string value_text(const config::OptionValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

page::PageDetails configuration_of(const run_files::FoundRun& run, const std::string& label) {
  const record::RunRecord& r = run.record;
  page::PageDetails details{fmt::format("{}: configuration {} and provenance", label, r.config_hash), {}};
  details.table.header = {"key", "value", "from"};
  const record::RecordedProvenance& p = r.provenance;
  const bool imported = r.timing.stages_ms.empty() && !r.program;  // it ran elsewhere, and was evaluated here
  const auto add = [&](const char* key, std::string value) {
    details.table.rows.push_back({{key, std::move(value), imported ? "the import" : "the run"}, ""});
  };
  add("version", p.version);
  add("git", p.git);
  add("compiler", p.compiler);
  add("flags", p.flags);
  add("cpu", p.cpu);
  add("threads", fmt::format("{}", p.threads));
  add("recording's fingerprint", r.recording.fingerprint);
  if (!imported) {
    add("peak memory", fmt::format("{:.0f} MB", static_cast<double>(r.timing.peak_rss_bytes) / 1e6));
    add("wall and CPU time", fmt::format("{:.1f} s, {:.1f} s", r.timing.wall_s, r.timing.cpu_s));
  }
  if (r.program) {
    add("program's version", r.program->version);
    add("program's seed", fmt::format("{}", r.program->seed));
    add("program's definition", r.program->definition);
  }
  for (const record::RecordedOption& option : r.config)
    details.table.rows.push_back({{option.key, value_text(option.value), option.origin}, ""});
  for (const std::string& note : r.recording.notes)
    details.table.rows.push_back({{"note on the recording", note, "the reader"}, ""});
  return details;
}

void add_charts(page::Page& page, std::string title, std::vector<page::Chart> charts, std::string text = "") {
  if (!charts.empty()) page.sections.push_back({std::move(title), std::move(text), std::move(charts), 3});
}

std::vector<run_files::FoundRun> runs_to_draw(Group group) {
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

/// Of the runs that have something to draw. colours: one a run of the group.
std::vector<run_charts::RunSeries> series_to_draw(Group drawn, Group group, const Labels& labels,
                                                  std::span<const std::size_t> colours,
                                                  std::vector<std::string>& warnings) {
  std::vector<run_charts::RunSeries> series;
  for (const run_files::FoundRun& run : drawn) {
    if (run.state != run_files::RunState::whole) {
      warnings.push_back(fmt::format("{}: {}", run.folder.string(), run.record.reason));
      continue;
    }
    if (run.record.frames.total == 0) continue;  // failed before its first frame: there is nothing to draw
    series.push_back(run_charts::series_of(run, labels[place_of(run, group)]));
    series.back().colour = colours[place_of(run, group)];
    warnings.insert(warnings.end(), series.back().warnings.begin(), series.back().warnings.end());
  }
  return series;
}

void add_curves(page::Page& page, std::span<const run_charts::RunSeries> series, const Detail& detail) {
  const bool revised =
      std::ranges::any_of(series, [](const run_charts::RunSeries& run) { return !run.final_poses.empty(); });
  const std::string which =
      revised ? "Poses as each was known when its frame came; final ones are under Loops and final poses."
              : "";
  add_charts(page, "Trajectories", run_charts::view_charts(series, detail.buckets), which);
  add_charts(page, "Position over time", run_charts::position_charts(series, detail.buckets), which);
  add_charts(page, "Errors", run_charts::error_charts(series, detail.buckets), which);
  for (page::PageSection& section : loop_sections(series, detail.buckets))
    page.sections.push_back(std::move(section));
  add_charts(page, "Motion and intensity", run_charts::motion_charts(series, detail.buckets));
}

void add_patches(page::Page& page, std::span<const LabelledPatches> patches,
                 std::span<const run_charts::RunSeries> series) {
  const PatchPictures pictures = patch_pictures(patches);
  if (pictures.pictures.empty()) return;
  const auto framed =
      std::ranges::find_if(series, [](const run_charts::RunSeries& run) { return !run.frames.empty(); });
  const auto time_s =
      framed == series.end() ? std::nullopt : std::optional(framed->time_s(pictures.timestamp_ns));
  page.sections.push_back({"Patches", pictures.text, page_images(pictures, time_s), 3});
}

Trajectory estimate_of(const std::vector<run_charts::ComparedPose>& poses) {
  Trajectory estimate;
  for (const run_charts::ComparedPose& pose : poses)
    estimate.push_back({pose.timestamp_ns, pose.T_truth_camera});
  return estimate;
}

/// Of the poses as each was known when its frame came, and, if the system revised them, at the end.
void add_failures(speed_failures::FailureSections& failures, const run_charts::RunSeries& run,
                  const std::string& method) {
  // Without a table of frames those with a pose are all that is known.
  std::vector<std::int64_t> stamps;
  for (const run_files::FrameTableRow& frame : run.frames) stamps.push_back(frame.timestamp_ns);
  if (stamps.empty()) {
    for (const run_charts::ComparedPose& pose : run.poses) stamps.push_back(pose.timestamp_ns);
  }
  failures.add(method, run.colour, run.truth, stamps, estimate_of(run.poses));
  if (!run.final_poses.empty())
    failures.add(method + ", final poses", run.colour, run.truth, stamps, estimate_of(run.final_poses));
}

/// What is the same for all recordings of a page.
struct PageContext {
  const std::vector<run_files::FoundRun>& runs;
  std::vector<std::string> methods;  ///< one a run: its variant, with the options that not all runs share
  std::vector<std::size_t> colours;  ///< one a run
  Detail detail;
  const FrameReader& reader;
};

void add_recording(ResultsPage& result, speed_failures::FailureSections& failures, Group group,
                   const PageContext& context) {
  page::Page& page = result.page;
  const Detail& detail = context.detail;
  const auto started = std::ranges::find_if(
      group, [](const run_files::FoundRun& run) { return run.record.recording.frames > 0; });
  const record::RecordedRecording& recording =
      (started == group.end() ? group.begin() : started)->record.recording;
  const Labels labels = run_files::run_labels(run_files::traits_of(group));
  page.sections.push_back({title_of(recording, context.runs),
                           started == group.end() ? "No run began." : facts_of(recording),
                           run_facts(group, labels)});
  page.sections.back().timeline = true;
  const std::vector<run_files::FoundRun> drawn = runs_to_draw(group);
  if (drawn.size() < group.size()) {
    page.sections.back().text +=
        fmt::format(" Of its {} runs, the {} with the smallest ATE are drawn.", group.size(), drawn.size());
  }
  const auto first = static_cast<std::size_t>(group.data() - context.runs.data());
  const auto colours = std::span(context.colours).subspan(first, group.size());
  const std::vector<run_charts::RunSeries> series =
      series_to_draw(drawn, group, labels, colours, result.warnings);
  const std::vector<LabelledPatches> patches = patches_of(drawn, group, labels, result.warnings);
  if (!series.empty()) {
    for (page::PageSection& section :
         frame_pictures(recording, series, patches, detail.in_between, context.reader, result.warnings))
      page.sections.push_back(std::move(section));
  }
  for (const run_charts::RunSeries& run : series)
    add_failures(failures, run, context.methods[first + place_of(*run.run, group)]);
  add_curves(page, series, detail);
  add_patches(page, patches, series);
  if (page::PageScene scene = model_scene(series, {detail.triangles, detail.buckets}, result.warnings);
      !scene.meshes.empty()) {
    page.sections.push_back(
        {"Models",
         "Simplified for this page; mesh.ply of each run has all triangles. Lines: the way of "
         "the camera, and where it was at the chosen time.",
         std::move(scene), 3});
  }
  add_charts(page, "Health and time", run_charts::tracking_charts(series, detail.buckets));
  add_charts(page, "Profiles", run_charts::profile_charts(series));
  std::vector<page::PageDetails> details;
  for (const run_files::FoundRun& run : drawn)
    details.push_back(configuration_of(run, labels[place_of(run, group)]));
  page.sections.push_back({"Configuration and provenance", "", std::move(details), 3});
}

std::vector<std::string> methods_of(const std::vector<run_files::FoundRun>& runs) {
  std::vector<std::string> methods = run_files::differing_edits(run_files::traits_of(runs));
  for (std::size_t i = 0; i < runs.size(); ++i)
    methods[i] = runs[i].record.variant + (methods[i].empty() ? "" : " ") + methods[i];
  return methods;
}

std::vector<std::size_t> colours_of(const std::vector<run_files::FoundRun>& runs,
                                    const std::vector<std::string>& methods) {
  std::vector<page::ColouredName> names;
  for (std::size_t i = 0; i < runs.size(); ++i)
    names.push_back({methods[i], run_files::variant_rank(runs[i].record.variant)});
  return page::series_colours(names);
}

}  // namespace

ResultsPage results_page(const std::vector<run_files::FoundRun>& runs, const std::string& title,
                         const FrameReader& reader) {
  ResultsPage result;
  const auto ok = std::ranges::count_if(
      runs, [](const run_files::FoundRun& run) { return run.record.status == record::RunStatus::ok; });
  result.page.title = title;
  result.page.subtitle = fmt::format("{} of {} runs ok.", ok, runs.size());
  result.page.sections = summary_sections(runs);
  result.tables = result.page.sections.size();
  const std::vector<Group> groups = groups_of(runs);
  std::size_t drawn = 0;
  for (const Group group : groups) drawn += std::min(group.size(), kMostDrawn);
  const std::vector<std::string> methods = methods_of(runs);
  const PageContext context{runs, methods, colours_of(runs, methods), detail_for(drawn, groups.size()),
                            reader};
  speed_failures::FailureSections failures;
  for (const Group group : groups) add_recording(result, failures, group, context);
  const std::vector<page::PageSection> by_speed = failures.sections();
  result.page.sections.insert(result.page.sections.begin() + static_cast<std::ptrdiff_t>(result.tables),
                              by_speed.begin(), by_speed.end());
  result.tables += by_speed.size();
  return result;
}

}  // namespace fusebench::report
