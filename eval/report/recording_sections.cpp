#include "eval/report/recording_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "eval/page/figures.hpp"
#include "eval/page/image_source.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/record/run_files/run_set.hpp"
#include "eval/report/loop_sections.hpp"
#include "eval/report/model_scene.hpp"
#include "eval/report/patch_pictures.hpp"
#include "eval/report/run_charts/profile_charts.hpp"
#include "eval/report/run_charts/run_charts.hpp"
#include "eval/report/run_charts/run_series.hpp"
#include "eval/report/run_configuration.hpp"

namespace fusebench::report {

namespace {

constexpr std::size_t kMostPictured = 2;  // variants whose patches are next to each other

using Sections = std::vector<page::PageSection>;

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
std::vector<LabelledPatches> patches_of(RunsOfRecording drawn, RunsOfRecording group, const RunLabels& labels,
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

void add_charts(Sections& sections, std::string title, std::vector<page::Chart> charts,
                std::string text = "") {
  if (!charts.empty()) sections.push_back({std::move(title), std::move(text), std::move(charts), 3});
}

/// Of the runs that have something to draw. colours: one a run of the group.
std::vector<run_charts::RunSeries> series_to_draw(RunsOfRecording drawn, RunsOfRecording group,
                                                  const RunLabels& labels,
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

void add_curves(Sections& sections, std::span<const run_charts::RunSeries> series, const PageDetail& detail) {
  const bool revised =
      std::ranges::any_of(series, [](const run_charts::RunSeries& run) { return !run.final_poses.empty(); });
  const std::string which = revised ? "Online poses, as estimated when each frame was processed; final poses "
                                      "are under Loops and final poses."
                                    : "";
  add_charts(sections, "Trajectories", run_charts::view_charts(series, detail.buckets), which);
  add_charts(sections, "Trajectories coloured by their error",
             run_charts::error_path_charts(series, detail.buckets), which);
  add_charts(sections, "Position over time", run_charts::position_charts(series, detail.buckets), which);
  add_charts(sections, "Errors", run_charts::error_charts(series, detail.buckets), which);
  for (page::PageSection& section : loop_sections(series, detail.buckets))
    sections.push_back(std::move(section));
  add_charts(sections, "Motion and intensity", run_charts::motion_charts(series, detail.buckets));
}

void add_patches(Sections& sections, std::span<const LabelledPatches> patches,
                 std::span<const run_charts::RunSeries> series) {
  const PatchPictures pictures = patch_pictures(patches);
  if (pictures.pictures.empty()) return;
  const auto framed =
      std::ranges::find_if(series, [](const run_charts::RunSeries& run) { return !run.frames.empty(); });
  const auto time_s =
      framed == series.end() ? std::nullopt : std::optional(framed->time_s(pictures.timestamp_ns));
  sections.push_back({"Patches", pictures.text, page_images(pictures, time_s), 3});
}

/// pictures: one a run of the group.
void add_models(RecordingSections& result, std::span<const run_charts::RunSeries> series,
                RunsOfRecording group, const PageContext& context, std::span<std::string> pictures) {
  const PageDetail& detail = context.detail;
  page::PageSection& head = result.sections.front();
  const PictureTaker write = [&](const run_charts::RunSeries& run, const ColorImage& picture) {
    auto file = context.writer(page::file_name_of(head.title + " " + run.label), picture);
    if (file) pictures[place_of(*run.run, group)] = std::move(*file);
    if (!file) result.warnings.push_back(file.error().message);
  };
  page::PageScene scene = model_scene(series, {detail.triangles, detail.buckets, detail.picture_width_px},
                                      context.writer ? write : PictureTaker(), result.warnings);
  auto& rows = std::get<page::PageTable>(head.content).rows;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].links = {pictures[i]};
  if (scene.meshes.empty()) return;
  result.sections.push_back(
      {"Models",
       "Simplified for this page; mesh.ply of each run has all triangles. Lines: camera path, "
       "and where the camera was at the chosen time.",
       std::move(scene), 3});
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

}  // namespace

RecordingSections recording_sections(RunsOfRecording group, const PageContext& context,
                                     speed_failures::FailureSections& failures) {
  RecordingSections result;
  Sections& sections = result.sections;
  const PageDetail& detail = context.detail;
  const auto started = std::ranges::find_if(
      group, [](const run_files::FoundRun& run) { return run.record.recording.frames > 0; });
  const record::RecordedRecording& recording =
      (started == group.end() ? group.begin() : started)->record.recording;
  const RunLabels labels = run_files::RunSet(group).labels();
  sections.push_back({title_of(recording, context.runs),
                      started == group.end() ? "No run began." : facts_of(recording),
                      run_facts(group, labels)});
  sections.back().timeline = true;
  const std::vector<run_files::FoundRun> drawn = runs_to_draw(group);
  if (drawn.size() < group.size()) {
    sections.back().text +=
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
      sections.push_back(std::move(section));
  }
  for (const run_charts::RunSeries& run : series)
    add_failures(failures, run, context.methods[first + place_of(*run.run, group)]);
  add_curves(sections, series, detail);
  add_patches(sections, patches, series);
  add_models(result, series, group, context, context.pictures.subspan(first, group.size()));
  add_charts(sections, "Health and time", run_charts::tracking_charts(series, detail.buckets));
  add_charts(sections, "Profiles", run_charts::profile_charts(series));
  std::vector<page::PageDetails> details;
  for (const run_files::FoundRun& run : drawn)
    details.push_back(configuration_of(run, labels[place_of(run, group)]));
  sections.push_back({"Configuration and provenance", "", std::move(details), 3});
  return result;
}

}  // namespace fusebench::report
