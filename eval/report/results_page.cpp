#include "eval/report/results_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "core/mesh/ply_file.hpp"
#include "eval/mesh_error/error_colors.hpp"
#include "eval/mesh_error/mesh_clustering.hpp"
#include "eval/mesh_error/mesh_metrics.hpp"
#include "eval/page/image_source.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/report/loop_sections.hpp"
#include "eval/report/patch_pictures.hpp"
#include "eval/report/profile_charts.hpp"
#include "eval/report/run_charts.hpp"
#include "eval/report/run_series.hpp"
#include "eval/run_files/record_files.hpp"
#include "eval/run_files/run_labels.hpp"
#include "eval/tables/systems_table.hpp"
#include "eval/tables/table.hpp"

namespace fusebench::report {

namespace {

constexpr double kLargestError_m = 0.05;
constexpr std::size_t kMostDrawn = 12;    // of a recording: more curves nobody can tell apart
constexpr std::size_t kMostPictured = 2;  // variants whose patches stand beside each other

/// How much of each run a page of so many runs shows.
struct Detail {
  std::size_t buckets = 0;    ///< of charts over time
  std::size_t triangles = 0;  ///< of a mesh
};

Detail detail_for(std::size_t runs) {
  constexpr std::size_t kBuckets = 12'000;  // of all runs together
  constexpr std::size_t kTriangles = 400'000;
  const std::size_t share = std::max<std::size_t>(runs, 1);
  return {std::clamp<std::size_t>(kBuckets / share, 40, 450),
          std::clamp<std::size_t>(kTriangles / share, 1'500, 40'000)};
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

const std::string& label_of(const run_files::FoundRun& run, Group group, const Labels& labels) {
  const auto found = std::ranges::find(group, run.folder, &run_files::FoundRun::folder);
  return labels[static_cast<std::size_t>(found - group.begin())];
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

page::PageTable page_table(const tables::ResultTable& table) {
  page::PageTable page;
  const auto lines = tables::table_cells(table);
  page.header = lines.front();
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const record::RunStatus status =
        i <= table.rows.size() ? table.rows[i - 1].status : record::RunStatus::ok;
    page.rows.push_back({lines[i], status == record::RunStatus::failed ? "error"
                                   : status == record::RunStatus::lost ? "warning"
                                                                       : ""});
  }
  return page;
}

page::PageTable lines_table(const std::vector<std::string>& lines) {
  page::PageTable table;
  for (const std::string& line : lines) table.rows.push_back({{line}, ""});
  return table;
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

std::vector<page::PageImage> page_images(const PatchPictures& pictures) {
  std::vector<page::PageImage> result;
  for (const PatchPicture& picture : pictures.pictures) {
    constexpr int kQuality = 92;
    result.push_back({picture.caption(), page::jpeg_source(picture.strip, kQuality)});
  }
  return result;
}

/// Of the first variants that kept their patches.
PatchPictures pictures_of(Group drawn, Group group, const Labels& labels,
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
    runs.push_back({label_of(run, group, labels), std::move(*frames)});
    variants.push_back(run.record.variant);
  }
  return patch_pictures(runs);
}

/// Stray bits of a mesh would make the rest small.
void look_at_most(page::PageScene& scene) {
  constexpr double kStray = 0.02;
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (const page::SceneMesh& mesh : scene.meshes) {
      for (const Vector3d& vertex : mesh.mesh.vertices) places.push_back(vertex[axis]);
    }
    if (places.empty()) return;
    std::ranges::sort(places);
    low[axis] = mesh_error::percentile(places, kStray);
    high[axis] = mesh_error::percentile(places, 1 - kStray);
  }
  scene.centre = 0.5 * (low + high);
  scene.radius_m = 0.5 * (high - low).norm();
}

page::PageScene scene_of(std::span<const RunSeries> runs, std::size_t triangles,
                         std::vector<std::string>& warnings) {
  page::PageScene scene;
  scene.largest_error_m = kLargestError_m;
  scene.up = {0, -1, 0};  // of the first camera, whose y points down
  for (const RunSeries& run : runs) {
    const auto file = run.run->folder / "mesh.ply";
    if (std::error_code ignored; !std::filesystem::exists(file, ignored)) continue;
    const auto checked = run_files::check_file(run.run->folder, run.run->record, "mesh.ply");
    const auto mesh = checked ? mesh::read_ply(file) : tl::unexpected(checked.error());
    if (!mesh) warnings.push_back(mesh.error().message);
    if (!mesh || mesh->triangles.empty()) continue;
    page::SceneMesh shown{run.label, mesh_error::reduced(*mesh, triangles), {}};
    for (Vector3d& vertex : shown.mesh.vertices) vertex = run.T_first_world * vertex;
    if (shown.mesh.colors.empty()) shown.mesh.colors.assign(shown.mesh.vertices.size(), Rgb{170, 170, 170});
    if (run.run->record.metrics.mesh.value && !shown.mesh.quality.empty()) {
      const std::vector<double> errors_m(shown.mesh.quality.begin(), shown.mesh.quality.end());
      shown.error_colors = mesh_error::error_colors(errors_m, kLargestError_m);
    }
    scene.meshes.push_back(std::move(shown));
  }
  look_at_most(scene);
  return scene;
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

void add_recording(ResultsPage& result, Group group, const std::vector<run_files::FoundRun>& all,
                   const Detail& detail) {
  page::Page& page = result.page;
  const auto started = std::ranges::find_if(
      group, [](const run_files::FoundRun& run) { return run.record.recording.frames > 0; });
  const record::RecordedRecording& recording =
      (started == group.end() ? group.begin() : started)->record.recording;
  const Labels labels = run_files::run_labels(run_files::traits_of(group));
  page.sections.push_back({title_of(recording, all),
                           started == group.end() ? "No run began." : facts_of(recording),
                           run_facts(group, labels)});
  const std::vector<run_files::FoundRun> drawn = runs_to_draw(group);
  if (drawn.size() < group.size()) {
    page.sections.back().text +=
        fmt::format(" Of its {} runs, the {} with the smallest ATE are drawn.", group.size(), drawn.size());
  }
  std::vector<RunSeries> series;
  for (const run_files::FoundRun& run : drawn) {
    if (run.state != run_files::RunState::whole) {
      result.warnings.push_back(fmt::format("{}: {}", run.folder.string(), run.record.reason));
      continue;
    }
    if (run.record.frames.total == 0) continue;  // failed before its first frame: there is nothing to draw
    series.push_back(series_of(run, label_of(run, group, labels)));
    for (const std::string& warning : series.back().warnings) result.warnings.push_back(warning);
  }
  const bool revised =
      std::ranges::any_of(series, [](const RunSeries& run) { return !run.final_poses.empty(); });
  const std::string which =
      revised ? "Poses as each was known when its frame came; final ones are under Loops and final poses."
              : "";
  add_charts(page, "Trajectories", view_charts(series, detail.buckets), which);
  add_charts(page, "Position over time", position_charts(series, detail.buckets), which);
  add_charts(page, "Errors", error_charts(series, detail.buckets), which);
  for (page::PageSection& section : loop_sections(series, detail.buckets))
    page.sections.push_back(std::move(section));
  add_charts(page, "Motion and intensity", motion_charts(series, detail.buckets));
  if (const PatchPictures pictures = pictures_of(drawn, group, labels, result.warnings);
      !pictures.pictures.empty())
    page.sections.push_back({"Patches", pictures.text, page_images(pictures), 3});
  if (page::PageScene scene = scene_of(series, detail.triangles, result.warnings); !scene.meshes.empty()) {
    page.sections.push_back(
        {"Models", "Simplified for this page; mesh.ply of each run has all triangles.", std::move(scene), 3});
  }
  add_charts(page, "Health and time", tracking_charts(series, detail.buckets));
  add_charts(page, "Profiles", profile_charts(series));
  std::vector<page::PageDetails> details;
  for (const run_files::FoundRun& run : drawn)
    details.push_back(configuration_of(run, label_of(run, group, labels)));
  page.sections.push_back({"Configuration and provenance", "", std::move(details), 3});
}

/// The table of systems and how to read it, where it says more than the table of runs.
void add_systems(page::Page& page, const std::vector<run_files::FoundRun>& runs) {
  if (!tables::compares_systems(runs)) return;
  const tables::SystemsTable systems = tables::systems_table_of(runs);
  const auto lines = tables::systems_table_cells(systems);
  page::PageTable table{lines.front(), {}};
  for (std::size_t i = 0; i < systems.rows.size(); ++i) {
    const tables::SystemRow& row = systems.rows[i];
    table.rows.push_back({lines[i + 1], row.runs == 0 ? "note" : row.ok < row.runs ? "warning" : ""});
  }
  page.sections.push_back({"Systems", "A row a recording, system and kind of poses.", std::move(table)});
  std::vector<std::string> remarks = systems.footer;
  remarks.insert(remarks.end(), systems.notes.begin(), systems.notes.end());
  page.sections.push_back({"How to read the table of systems", "", lines_table(remarks), 3});
}

}  // namespace

ResultsPage results_page(const std::vector<run_files::FoundRun>& runs, const std::string& title) {
  ResultsPage result;
  const tables::ResultTable table = tables::table_of(runs);
  const auto ok = std::ranges::count(table.rows, record::RunStatus::ok, &tables::TableRow::status);
  result.page.title = title;
  result.page.subtitle = fmt::format("{} of {} runs ok.", ok, runs.size());
  const bool revised = std::ranges::any_of(
      runs, [](const run_files::FoundRun& run) { return run.record.final_metrics.has_value(); });
  result.page.sections.push_back({"Results",
                                  revised
                                      ? "Of runs that revised their poses at the end: the online ones; the "
                                        "final ones are in the table of systems below."
                                      : "",
                                  page_table(table)});
  std::vector<std::string> remarks = table.footer;
  remarks.insert(remarks.end(), table.notes.begin(), table.notes.end());
  result.page.sections.push_back({"How to read the columns", "", lines_table(remarks), 3});
  add_systems(result.page, runs);
  result.tables = result.page.sections.size();
  std::size_t drawn = 0;
  for (const Group group : groups_of(runs)) drawn += std::min(group.size(), kMostDrawn);
  const Detail detail = detail_for(drawn);
  for (const Group group : groups_of(runs)) add_recording(result, group, runs, detail);
  return result;
}

}  // namespace fusebench::report
