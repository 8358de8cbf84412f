#include "eval/paper_figures/paper_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/mesh/ply_file.hpp"
#include "datasets/images/image_files.hpp"
#include "eval/page/image_source.hpp"
#include "eval/paper_figures/model_view.hpp"
#include "eval/report/patch_pictures.hpp"
#include "eval/report/run_charts.hpp"
#include "eval/report/run_series.hpp"
#include "eval/run_files/patch_table.hpp"

namespace fusebench::paper_figures {

namespace {

constexpr std::size_t kBuckets = 400;
constexpr int kQuality = 92;

/// A recording's runs with what their files say.
struct Loaded {
  std::string label;
  std::vector<run_files::FoundRun> runs;
  std::vector<report::RunSeries> series;
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
      one.series.push_back(report::series_of(run, run.record.variant));
      for (const std::string& warning : one.series.back().warnings) written.warnings.push_back(warning);
    }
  }
  return loaded;
}

std::vector<report::RunSeries> with_variants(const Loaded& recording,
                                             std::span<const std::string_view> variants) {
  std::vector<report::RunSeries> chosen;
  for (const std::string_view variant : variants) {
    const auto found = std::ranges::find(recording.series, variant, &report::RunSeries::label);
    if (found != recording.series.end()) chosen.push_back(*found);
  }
  return chosen;
}

/// Linear and angular speed over time, by the true poses.
void add_speeds(const Loaded& recording, page::Page& page) {
  constexpr std::size_t kSpeeds = 2;  // the first of the charts of motion
  auto charts = report::motion_charts(recording.series, kBuckets);
  if (charts.size() > kSpeeds) charts.resize(kSpeeds);
  page.sections.push_back(
      {"Speed " + recording.label, "Speed of the camera over time, by the true poses.", std::move(charts)});
}

/// With and without an IMU, from above.
void add_imu_experiment(const Loaded& recording, page::Page& page) {
  constexpr std::array<std::string_view, 2> kVariants = {"full", "no-imu"};
  const auto series = with_variants(recording, kVariants);
  auto charts = report::view_charts(series, kBuckets);
  auto errors = report::error_charts(series, kBuckets);
  if (charts.size() > 1) charts.resize(1);
  if (!errors.empty()) charts.push_back(std::move(errors.front()));
  page.sections.push_back({"IMU " + recording.label,
                           "The same estimator with and without the inertial prior.", std::move(charts)});
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
    const std::string title = fmt::format("{}, {:.1f} grey levels: before | expected | seen | difference",
                                          picture.run, picture.difference_grey);
    if (auto added = figure.add(folder, title, picture.strip); !added) return added;
  }
  written.page.sections.push_back({"Patches " + recording.label, pictures.text, figure.images});
  return draw(figure, folder, format);
}

/// From behind and above the first camera, so that drift shows as what does not fit.
constexpr double kFocal_px = 300;
constexpr int kViewWidth_px = 400;
constexpr int kViewHeight_px = 320;

PinholeCamera view_camera() {
  PinholeCamera camera;
  camera.width_px = kViewWidth_px;
  camera.height_px = kViewHeight_px;
  camera.fx_px = camera.fy_px = kFocal_px;
  camera.cx_px = 0.5 * (kViewWidth_px - 1);
  camera.cy_px = 0.5 * (kViewHeight_px - 1);
  return camera;
}

/// Of the view, in the frame of the first camera of a run (x right, y down, z forward).
SE3 T_first_view() { return {so3_exp({radians(-25.0), 0, 0}), {0, -1.5, -2.5}}; }

Result<void> add_models(std::span<const Loaded> recordings, const std::filesystem::path& folder,
                        page::FigureFormat format, WrittenFigures& written) {
  ImageFigure figure{"models", 0, {}, {}, {}};
  for (const Loaded& recording : recordings) {
    figure.columns = std::max(figure.columns, recording.series.size());
    for (const report::RunSeries& run : recording.series) {
      const auto mesh = mesh::read_ply(run.run->folder / "mesh.ply");
      if (!mesh) {
        written.warnings.push_back(mesh.error().message);
        continue;
      }
      const SE3 T_world_view = run.T_first_world.inverse() * T_first_view();
      const ColorImage image = model_view(mesh->cast<float>(), view_camera(), T_world_view);
      if (auto added = figure.add(folder, fmt::format("{}, {}", recording.label, run.label), image); !added)
        return added;
    }
  }
  written.page.sections.push_back({"Reconstructions",
                                   "Models of all methods from one camera, behind and above the first one, "
                                   "at one scale. Walls that face away are looked through.",
                                   figure.images});
  return draw(figure, folder, format);
}

}  // namespace

Result<WrittenFigures> write_paper_figures(std::span<const RecordingRuns> recordings,
                                           const std::filesystem::path& folder, page::FigureFormat format) {
  WrittenFigures written;
  written.page.title = "The paper's figures, from runs made here";
  written.page.subtitle = "Recordings are simulated unless their names say otherwise.";
  const std::vector<Loaded> loaded = load_all(recordings, written);
  for (const Loaded& recording : loaded) add_speeds(recording, written.page);
  for (const Loaded& recording : loaded) add_imu_experiment(recording, written.page);
  const auto charts = page::write_figures(written.page, folder, format);
  if (!charts) return tl::unexpected(charts.error());
  for (const Loaded& recording : loaded) {
    if (auto added = add_patches(recording, folder, format, written); !added)
      return tl::unexpected(added.error());
  }
  if (auto added = add_models(loaded, folder, format, written); !added) return tl::unexpected(added.error());
  return written;
}

}  // namespace fusebench::paper_figures
