#include "eval/report/paper_figures/paper_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/mesh/ply_file.hpp"
#include "datasets/images/image_files.hpp"
#include "eval/metrics/mesh_error/surfel_discs.hpp"
#include "eval/page/image_source.hpp"
#include "eval/record/run_files/patch_table.hpp"
#include "eval/report/model_view.hpp"
#include "eval/report/patch_pictures.hpp"
#include "eval/report/run_charts/run_charts.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::paper_figures {

namespace {

constexpr std::size_t kBuckets = 400;
constexpr int kQuality = 92;

/// A recording's runs with what their files say.
struct Loaded {
  std::string label;
  std::vector<run_files::FoundRun> runs;
  std::vector<run_charts::RunSeries> series;
};

std::vector<Loaded> load_all(std::span<const RecordingRuns> recordings, WrittenFigures& written) {
  std::vector<Loaded> loaded;
  for (const RecordingRuns& recording : recordings) {
    Loaded& one = loaded.emplace_back(Loaded{recording.label, {}, {}});
    for (const run_files::FoundRun& run : recording.runs) {
      if (run.state == run_files::RunState::whole && run.record.frames.total > 0) {
        one.runs.push_back(run);
      } else {
        written.warnings.push_back(fmt::format("{}: {}", run.folder.string(), run.record.reason));
      }
    }
    for (const run_files::FoundRun& run : one.runs) {
      one.series.push_back(run_charts::series_of(run, run.record.variant));
      for (const std::string& warning : one.series.back().warnings) written.warnings.push_back(warning);
    }
    run_charts::colour_by_variant(one.series);
  }
  return loaded;
}

std::vector<run_charts::RunSeries> with_variants(const Loaded& recording,
                                                 std::span<const std::string_view> variants) {
  std::vector<run_charts::RunSeries> chosen;
  for (const std::string_view variant : variants) {
    const auto found = std::ranges::find(recording.series, variant, &run_charts::RunSeries::label);
    if (found != recording.series.end()) chosen.push_back(*found);
  }
  return chosen;
}

/// Linear and angular speed over time, by the true poses.
void add_speeds(const Loaded& recording, page::Page& page) {
  constexpr std::size_t kSpeeds = 2;  // the first of the charts of motion
  auto charts = run_charts::motion_charts(recording.series, kBuckets);
  if (charts.size() > kSpeeds) charts.resize(kSpeeds);
  for (page::Chart& chart : charts) {
    for (page::ChartSeries& series : chart.series) series.label = recording.label + ", by the true poses";
  }
  page.sections.push_back(
      {"Speed " + recording.label, "Speed of the camera over time, by the true poses.", std::move(charts)});
}

/// "full: ATE 0.19 cm, 237 of 237 frames tracked; no-imu: ..."
std::string results_of(std::span<const run_charts::RunSeries> series) {
  std::string text;
  for (const run_charts::RunSeries& run : series) {
    const record::RunRecord& record = run.run->record;
    text += text.empty() ? "" : "; ";
    text += run.label + ": ";
    if (record.metrics.ate.value)
      text += fmt::format("ATE {:.2f} cm, ", 100 * record.metrics.ate.value->stats.rmse);
    text += fmt::format("{} of {} frames tracked", record.frames.tracked, record.frames.total);
    if (const auto silent = record.metrics.silent_frames(); silent.value_or(0) > 0)
      text += fmt::format(", {} undetected failure{}", *silent, *silent == 1 ? "" : "s");
  }
  return text + ".";
}

/// With and without an IMU, from above.
void add_imu_experiment(const Loaded& recording, page::Page& page) {
  constexpr std::array<std::string_view, 2> kVariants = {"full", "no-imu"};
  const auto series = with_variants(recording, kVariants);
  auto charts = run_charts::view_charts(series, kBuckets);
  auto errors = run_charts::error_charts(series, kBuckets);
  if (charts.size() > 1) charts.resize(1);
  if (!errors.empty()) charts.push_back(std::move(errors.front()));
  page.sections.push_back({"IMU " + recording.label,
                           "The same estimator with and without the inertial prior. " + results_of(series) +
                               " Lines end where a method is lost; what differs by less than a millimetre "
                               "or two is no difference.",
                           std::move(charts)});
}

/// Images of one figure, as files and for the page.
struct ImageFigure {
  std::string name;
  std::size_t columns = 1;
  Eigen::Vector2i size_px = Eigen::Vector2i::Zero();
  std::vector<page::Panel> panels;
  std::vector<page::PageImage> images;

  Result<void> add(const std::filesystem::path& folder, const std::string& title, const ColorImage& image) {
    const std::string file = fmt::format("{}-{}.png", name, panels.size() + 1);
    if (auto written = images::write_png(folder / file, image); !written) return written;
    size_px = size_px.cwiseMax(Eigen::Vector2i(image.width, image.height));
    panels.push_back({title, file});
    images.push_back({title, page::jpeg_source(image, kQuality)});
    return {};
  }
};

Result<void> draw(const ImageFigure& figure, const std::filesystem::path& folder, page::FigureFormat format) {
  if (figure.panels.empty()) return {};
  const std::string file = page::figure_file(figure.name, format);
  return page::draw_figure(page::panels_script(figure.panels, figure.columns, figure.size_px, file, format),
                           folder, figure.name, format);
}

/// Both methods on patches of the frame in which patches moved most.
Result<void> add_patches(const Loaded& recording, const std::filesystem::path& folder,
                         page::FigureFormat format, WrittenFigures& written) {
  std::vector<report::LabelledPatches> methods;
  for (const run_files::FoundRun& run : recording.runs) {
    if (run.record.variant != "full" && run.record.variant != "dm") continue;
    auto frames = run_files::read_patch_table(run.folder);
    if (!frames) {
      written.warnings.push_back(frames.error().message);
      continue;
    }
    methods.push_back({run.record.variant, std::move(*frames)});
  }
  const report::PatchPictures pictures = report::patch_pictures(methods);
  ImageFigure figure{"patches_" + recording.label, std::max<std::size_t>(1, methods.size()), {}, {}, {}};
  for (const report::PatchPicture& picture : pictures.pictures) {
    // The first row says what the four tiles are.
    const bool first = figure.panels.size() < figure.columns;
    const std::string title = fmt::format("{}: {:.1f} grey levels{}", picture.run, picture.difference_grey,
                                          first ? " (before, expected, seen, difference)" : "");
    if (auto added = figure.add(folder, title, picture.strip); !added) return added;
  }
  const std::string text = pictures.text.empty()
                               ? "Nothing to show: there is no frame of which both methods keep the patches."
                               : pictures.text;
  written.page.sections.push_back(
      {"Patches " + recording.label, text, figure.images, 2, false, figure.columns});
  return draw(figure, folder, format);
}

constexpr int kViewWidth_px = 400;
constexpr int kViewHeight_px = 320;
constexpr double kStray = 0.02;  // share of the first model that is not in view, at each side

/// Of the view, in the frame of the first camera of a run (x right, y down, z forward): from behind and
/// above, so that drift shows as what does not fit.
SE3 T_first_view() { return {so3_exp({radians(-25.0), 0, 0}), {0, -1.5, -2.5}}; }

/// The models of all methods, by one camera.
Result<void> add_models(const Loaded& recording, const std::filesystem::path& folder,
                        page::FigureFormat format, WrittenFigures& written) {
  ImageFigure figure{
      "models_" + recording.label, std::max<std::size_t>(1, recording.series.size()), {}, {}, {}};
  std::optional<PinholeCamera> camera;
  for (const run_charts::RunSeries& run : recording.series) {
    auto mesh = mesh::read_ply(run.run->folder / "mesh.ply");
    if (!mesh) {
      written.warnings.push_back(mesh.error().message);
      continue;
    }
    mesh = mesh_error::with_discs(*std::move(mesh));
    const SE3 T_world_view = run.T_first_world.inverse() * T_first_view();
    if (!camera) {
      camera = report::camera_around(report::seen_box(mesh->vertices, T_world_view, kStray), kViewWidth_px,
                                     kViewHeight_px);
    }
    const ColorImage image = report::model_view(mesh->cast<float>(), *camera, T_world_view);
    const auto& ate = run.run->record.metrics.ate.value;
    const std::string error = ate ? fmt::format(": ATE {:.2f} cm", 100 * ate->stats.rmse) : "";
    if (auto added = figure.add(folder, run.label + error, image); !added) return added;
  }
  written.page.sections.push_back(
      {"Reconstructions " + recording.label,
       "Models of all methods by one camera, behind and above the first pose of each. " +
           results_of(recording.series) + " Walls that face away are left out.",
       figure.images, 2, false, figure.columns});
  return draw(figure, folder, format);
}

}  // namespace

Result<WrittenFigures> write_paper_figures(std::span<const RecordingRuns> recordings,
                                           const std::filesystem::path& folder, page::FigureFormat format) {
  WrittenFigures written;
  written.page.title = "The paper's figures, from runs made here";
  written.page.subtitle =
      "All recordings are simulated (a ZR300 in a room, 8 s): slow and fast by a camera without faults, "
      "turns by realistic sensors that are not told. full: the system of the paper; no-imu: the same without "
      "the "
      "inertial prior; dm: squares that are moved as a whole, as a direct method does; infinitam "
      "and elasticfusion: the methods of these systems, which have no IMU. Each figure is a file beside this "
      "page, with the script that draws it (.gp).";
  const std::vector<Loaded> loaded = load_all(recordings, written);
  for (const Loaded& recording : loaded) add_speeds(recording, written.page);
  for (const Loaded& recording : loaded) add_imu_experiment(recording, written.page);
  const auto charts = page::write_figures(written.page, folder, format);
  if (!charts) return tl::unexpected(charts.error());
  for (const Loaded& recording : loaded) {
    if (auto added = add_patches(recording, folder, format, written); !added)
      return tl::unexpected(added.error());
  }
  for (const Loaded& recording : loaded) {
    if (auto added = add_models(recording, folder, format, written); !added)
      return tl::unexpected(added.error());
  }
  return written;
}

}  // namespace fusebench::paper_figures
