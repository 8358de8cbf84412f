#include "eval/report/results_page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/mesh/ply_file.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/page/figures.hpp"
#include "eval/report/frame_pictures.hpp"
#include "eval/report/run_charts/loop_charts.hpp"
#include "eval/report/run_charts/profile_charts.hpp"
#include "eval/report/run_charts/run_charts.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_meshes.hpp"

namespace fusebench {

using namespace simd;
using namespace trajectory;
using namespace mesh;
using namespace health;
using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace run_files;
using namespace page;
using namespace run_charts;
using namespace report;

namespace {

constexpr std::int64_t kStart_ns = 1'305'031'229'000'000'000;
constexpr int kFrames = 60;

/// A camera on a circle of 1 m, and runs that are off by a constant once aligned, or lost at the end.
class ResultsPageTest : public testing::InTemporaryFolder {
 protected:
  static Trajectory circle(int frames) {
    Trajectory trajectory;
    for (int i = 0; i < frames; ++i) {
      const double angle = 0.1 * i;
      trajectory.push_back(
          {kStart_ns + i * 33'000'000LL,
           {so3_exp({0, 0, angle}), {std::cos(angle), std::sin(angle), 0.1 * std::sin(3 * angle)}}});
    }
    return trajectory;
  }

  FoundRun add_run(const std::string& variant, int tracked, const SE3& T_truth_world) {
    RunRecord record;
    record.status = tracked == kFrames ? RunStatus::ok : RunStatus::lost;
    record.reason = tracked == kFrames ? "" : "lost at the end";
    record.recording.name = "circle";
    record.recording.frames = kFrames;
    record.recording.truth = "given";
    record.variant = variant;
    record.frames = {kFrames, static_cast<std::size_t>(tracked), static_cast<std::size_t>(kFrames - tracked)};
    record.timing.stages_ms = {{"update", 12.0}, {"fuse", 3.0}};
    AteResult ate;
    ate.stats = statistics(std::vector<double>{0.01});
    ate.alignment = {"se3", T_truth_world};
    record.metrics.ate = {ate, {}};
    const auto folder = std::filesystem::path("runs") / "circle" / variant / "01234567";
    write(folder / "record.json", to_json(record));
    Trajectory estimate = circle(tracked);
    for (StampedPose& pose : estimate) {
      pose.T_world_camera = T_truth_world.inverse() * pose.T_world_camera;
      pose.T_world_camera.translation += T_truth_world.rotation.inverse() * Vector3d(0, 0, 0.02);
    }
    write(folder / "trajectory.tum", tum_text(estimate));
    write(folder / "truth.tum", tum_text(circle(kFrames)));
    std::string table = frame_table_header();
    for (int i = 0; i < kFrames; ++i) {
      FrameReport report;
      report.timestamp_ns = kStart_ns + i * 33'000'000LL;
      report.status = i < tracked ? FrameStatus::tracked : FrameStatus::lost;
      report.patches_accepted = 50;
      table += frame_table_row(static_cast<std::size_t>(i), report, &report, 1);
    }
    write(folder / "frames.csv", table);
    Mesh mesh = testing::sphere(1, 10).cast<float>();
    mesh.colors.assign(mesh.vertices.size(), Rgb{1, 2, 3});
    mesh.quality.assign(mesh.vertices.size(), 0.01F);
    EXPECT_TRUE(write_ply(mesh, folder_ / folder / "mesh.ply").has_value());
    return {folder_ / folder, record};
  }
};

const ChartSeries& series_of_chart(const std::vector<Chart>& charts, const std::string& title,
                                   const std::string& label) {
  const auto chart = std::ranges::find(charts, title, &Chart::title);
  if (chart == charts.end()) throw std::runtime_error("no chart " + title);
  const auto series = std::ranges::find(chart->series, label, &ChartSeries::label);
  if (series == chart->series.end()) throw std::runtime_error("no series " + label);
  return *series;
}

TEST_F(ResultsPageTest, ChartsShowWhatTheFilesSay) {
  const SE3 T_truth_world{so3_exp({0.3, -0.2, 0.5}), {4, 5, 6}};
  const FoundRun full = add_run("full", kFrames, T_truth_world);
  const FoundRun no_imu = add_run("no-imu", 30, T_truth_world);
  const std::vector<RunSeries> runs = {series_of(full, "full"), series_of(no_imu, "no-imu")};
  for (const RunSeries& run : runs) EXPECT_TRUE(run.warnings.empty());

  const auto errors = error_charts(runs, 100);
  for (const Vector2d& point : series_of_chart(errors, "Position error", "full").points)
    EXPECT_NEAR(point.y(), 2, 1e-6);  // centimetres
  EXPECT_NEAR(series_of_chart(errors, "Cumulative position error", "full").points.back().y(), 100, 1e-9);
  EXPECT_NEAR(series_of_chart(errors, "Cumulative position error", "no-imu").points.back().y(), 50, 1e-9);
  for (const ChartBox& box :
       series_of_chart(errors, "Relative error over segments of the path", "full").boxes) {
    EXPECT_NEAR(box.max, 0, 1e-6);  // a constant offset is no relative error
    EXPECT_LE(box.min, box.median);
  }

  const auto motion = motion_charts(runs, 100);
  for (const Vector2d& point : series_of_chart(motion, "Angular speed of the camera", "ground truth").points)
    EXPECT_NEAR(point.y(), degrees(0.1) / 0.033, 1e-6);

  const auto views = view_charts(runs, 200);
  ASSERT_EQ(views.size(), 3U);
  for (const Vector2d& point : series_of_chart(views, "x-y view", "full").points)
    EXPECT_NEAR(point.norm(), 1, 1e-6);

  const auto tracking = tracking_charts(runs, 100);
  EXPECT_EQ(series_of_chart(tracking, "Accepted patches and lost frames", "no-imu, lost").points.size(), 30U);
  EXPECT_EQ(series_of_chart(tracking, "Time of the stages", "update").points[1].y(), 12);
}

TEST_F(ResultsPageTest, PathsAreColouredByTheirErrorsInOneRange) {
  const FoundRun full = add_run("full", kFrames, SE3{});
  const FoundRun no_imu = add_run("no-imu", 30, SE3{});
  std::vector<RunSeries> runs = {series_of(full, "full"), series_of(no_imu, "no-imu")};
  runs[1].poses[7].error_m = 0.06;
  const auto charts = error_path_charts(runs, 100);
  ASSERT_EQ(charts.size(), 2U);
  const ChartSeries& path = series_of_chart(charts, "x-y view by error: no-imu", "no-imu");
  ASSERT_EQ(path.values.size(), path.points.size());
  EXPECT_NEAR(path.values[7], 6, 1e-9);
  EXPECT_NEAR(path.values[8], 2, 1e-6);
  for (const Chart& chart : charts) {
    EXPECT_NEAR(chart.value_colours->top, 6, 1e-9);
    EXPECT_EQ(chart.value_colours->label, "position error [cm]");
  }
  const std::string html = to_html({"t", "", {{"s", "", charts}}});
  EXPECT_NE(html.find("<span>6 and more</span><span>position error [cm]</span>"), std::string::npos);
  EXPECT_NE(html.find(",6.0]"), std::string::npos) << "a point with its value";
  EXPECT_NE(gnuplot_script(charts[1], "f.svg", FigureFormat::svg).find("lc palette"), std::string::npos);
  runs[0].poses.clear();
  runs[1].poses.clear();
  EXPECT_TRUE(error_path_charts(runs, 100).empty());
}

TEST_F(ResultsPageTest, TheFirstBinOfAHistogramIsAsWideAsTheOthers) {
  const FoundRun full = add_run("full", kFrames, SE3{});
  const auto charts = error_charts(std::vector<RunSeries>{series_of(full, "full")}, 100);
  const auto& points = series_of_chart(charts, "Histogram of position errors", "full").points;
  ASSERT_EQ(points.size(), 30U);
  EXPECT_NEAR(points[0].x(), 0.5 * (points[1].x() - points[0].x()), 1e-9)
      << "middles of bins that begin at zero";
}

TEST_F(ResultsPageTest, TheCertaintyOfTheFilterIsABand) {
  const FoundRun full = add_run("full", kFrames, SE3{});
  const auto charts = error_charts(std::vector<RunSeries>{series_of(full, "full")}, 100);
  EXPECT_EQ(series_of_chart(charts, "Drift against the filter's own 3 sigma", "full, 3 sigma").style,
            SeriesStyle::band);
}

TEST_F(ResultsPageTest, PicturesShowTheFirstFrameAndTheWorst) {
  FoundRun full = add_run("full", kFrames, SE3{});
  RunSeries series = series_of(full, "full");
  series.poses[40].error_m = 0.07;
  std::vector<std::size_t> asked;
  const FrameReader reader = [&](const RecordedRecording&, std::span<const std::size_t> frames) {
    asked.assign(frames.begin(), frames.end());
    return Result<std::vector<ColorImage>>(
        std::vector<ColorImage>(frames.size(), ColorImage(64, 48, Rgb{9, 9, 9})));
  };
  std::vector<std::string> warnings;
  const auto sections = frame_pictures(full.record.recording, std::vector{series}, {}, 3, reader, warnings);
  EXPECT_EQ(asked, (std::vector<std::size_t>{0, 29, 40, 59}));
  ASSERT_EQ(sections.size(), 2U);
  const auto& scene = std::get<std::vector<PageImage>>(sections[0].content);
  ASSERT_EQ(scene.size(), 2U);
  EXPECT_EQ(scene[1].caption, "largest error of full, 7.00 cm, frame 40");
  EXPECT_NEAR(*scene[1].time_s, 40 * 0.033, 1e-6);
  EXPECT_TRUE(sections[1].strip);

  const FrameReader gone = [](const RecordedRecording&, std::span<const std::size_t>) {
    return Result<std::vector<ColorImage>>(
        fail(ErrorCode::data_missing, "circle: no such folder", "--data FOLDER shows them"));
  };
  const auto without = frame_pictures(full.record.recording, std::vector{series}, {}, 3, gone, warnings);
  ASSERT_EQ(without.size(), 1U);
  EXPECT_EQ(without[0].text,
            "No images of the recording (circle: no such folder). --data FOLDER "
            "shows them.");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("--data FOLDER"), std::string::npos) << warnings[0];
}

TEST_F(ResultsPageTest, PicturesHaveTheFramesNumbersOfTheRecordingAlsoOfImportedRuns) {
  FoundRun full = add_run("full", kFrames, SE3{});
  FoundRun imported = add_run("other", kFrames, SE3{});
  full.record.recording.first_frame = imported.record.recording.first_frame = 300;
  full.record.recording.whole_frames = 700;
  std::vector<RunSeries> series = {series_of(full, "full"), series_of(imported, "other")};
  series[1].frames.clear();
  series[1].poses[40].error_m = 0.07;
  std::vector<std::size_t> asked;
  const FrameReader reader = [&](const RecordedRecording&, std::span<const std::size_t> frames) {
    asked.assign(frames.begin(), frames.end());
    return Result<std::vector<ColorImage>>(
        std::vector<ColorImage>(frames.size(), ColorImage(64, 48, Rgb{9, 9, 9})));
  };
  std::vector<std::string> warnings;
  const auto sections = frame_pictures(full.record.recording, series, {}, 0, reader, warnings);
  EXPECT_TRUE(std::ranges::count(asked, 40U)) << "counted from the first frame of the window";
  const auto& scene = std::get<std::vector<PageImage>>(sections.at(0).content);
  ASSERT_EQ(scene.size(), 3U);
  EXPECT_EQ(scene[2].caption, "largest error of other, 7.00 cm, frame 340");
  testing::expect_contains(to_html(results_page({full}, "t").page), "circle, frames 300:360");
}

TEST_F(ResultsPageTest, AModelHasTheWayOfItsCameraAndItsBoxAndTheSameColourAsItsCurves) {
  add_run("full", kFrames, SE3{so3_exp({0.3, -0.2, 0.5}), {4, 5, 6}});
  add_run("no-imu", kFrames, SE3{});
  const auto runs = find_runs(folder_ / "runs");
  ASSERT_TRUE(runs.has_value());
  const ResultsPage result = results_page(*runs, "Circles");
  const auto models = std::ranges::find(result.page.sections, "Models", &PageSection::title);
  ASSERT_NE(models, result.page.sections.end());
  const auto& scene = std::get<PageScene>(models->content);
  ASSERT_EQ(scene.paths.size(), 2U);
  EXPECT_EQ(scene.paths[0].colour, 1U);
  EXPECT_EQ(scene.paths[1].colour, 3U);
  EXPECT_LT(scene.paths[0].poses.front().T_scene_camera.translation.norm(), 1e-9)
      << "it begins at the origin";
  const Trajectory poses = circle(kFrames);
  const SE3 T_first_30 = poses[0].T_world_camera.inverse() * poses[30].T_world_camera;
  EXPECT_NEAR((scene.paths[0].poses[30].T_scene_camera.translation - T_first_30.translation).norm(), 0, 1e-6);
  EXPECT_NEAR(scene.paths[0].poses[30].time_s, 30 * 0.033, 1e-6);
  EXPECT_TRUE((scene.high.array() > scene.low.array()).all());
}

TEST_F(ResultsPageTest, WritesAPictureOfEachModelAndLinksIt) {
  const FoundRun run = add_run("full", kFrames, SE3{});
  std::vector<std::string> names;
  const PictureWriter writer = [&](const std::string& name,
                                   const ColorImage& picture) -> Result<std::string> {
    EXPECT_EQ(picture.width, 800);
    names.push_back(name);
    return name + ".png";
  };
  const ResultsPage result = results_page({run}, "Circles", {}, writer);
  EXPECT_EQ(names, std::vector<std::string>{"circle_full"});
  const std::string html = to_html(result.page);
  std::size_t links = 0;
  for (std::size_t at = html.find("<a href=\"circle_full.png\">"); at != std::string::npos; ++links)
    at = html.find("<a href=\"circle_full.png\">", at + 1);
  EXPECT_EQ(links, 2U) << "in the overview and among the runs of the recording";
  // The page itself has it where meshes cannot be drawn.
  testing::expect_contains(html, "<img alt=\"model: full\" src=\"data:image/png;base64,");
  EXPECT_EQ(to_html(results_page({run}, "Circles").page).find("href=\"circle_full"), std::string::npos);
}

TEST_F(ResultsPageTest, TheHeadSaysWhatWasFoundBeforeAllTables) {
  add_run("full", kFrames, SE3{});
  add_run("no-imu", 30, SE3{});
  const auto runs = find_runs(folder_ / "runs");
  ASSERT_TRUE(runs.has_value());
  const ResultsPage result = results_page(*runs, "Circles");
  EXPECT_EQ(result.page.sections.front().title, "ATE [cm] by recording and method");
  EXPECT_EQ(result.page.sections[1].title, "What was found");
  const auto& lines = std::get<PageParagraphs>(result.page.sections[1].content).lines;
  EXPECT_NE(lines[0].find("full"), std::string::npos) << lines[0];
  const bool failed = std::ranges::any_of(lines, [](const std::string& line) {
    return line.find("no-imu on circle (lost: lost at the end)") != std::string::npos;
  });
  EXPECT_TRUE(failed);
  EXPECT_EQ(result.page.sections[2].title, "What was compared");
  EXPECT_TRUE(result.page.sections[2].folded) << "details";
}

TEST_F(ResultsPageTest, OnlyProfiledRunsHaveAProfile) {
  const FoundRun plain = add_run("dm", kFrames, SE3{});
  FoundRun profiled = add_run("full", kFrames, SE3{});
  EXPECT_EQ(to_html(results_page({plain, profiled}, "t").page).find("Profiles"), std::string::npos);
  profiled.record.timing.histograms = {{"update", histogram_of({10, 10, 11, 30})},
                                       {"fuse", histogram_of({4, 4, 4})},
                                       {"frame", histogram_of({20, 20, 21, 40})}};
  const std::vector<RunSeries> runs = {series_of(plain, "dm"), series_of(profiled, "full")};
  const auto charts = profile_charts(runs);
  ASSERT_EQ(charts.size(), 1U);
  EXPECT_EQ(
      charts[0].caption,
      "Of 4 frames, half took 20.5 ms or less, one in ten 34.3 ms or more, the slowest 40 ms. The stage "
      "that takes most is update: 10.5 ms at the median, 24.3 ms or more in one frame of ten.");
  for (const ChartSeries& series : charts[0].series) {
    double sum = 0;
    for (const Vector2d& point : series.points) {
      EXPECT_GT(point.x(), 0);  // of a logarithmic axis
      sum += point.y();
    }
    EXPECT_NEAR(sum, 100, 1e-9) << series.label;
  }
  EXPECT_NE(to_html(results_page({plain, profiled}, "t").page).find("Profiles"), std::string::npos);
}

/// Loops from the tenth frame to the fortieth and fiftieth, which make the poses right; the twentieth was
/// compared as well.
class LoopsPageTest : public ResultsPageTest {
 protected:
  FoundRun add_run_with_loops(std::size_t refused) {
    const auto stamp = [](std::size_t frame) {
      return fmt::format(
          "{:.6f}", 1e-9 * static_cast<double>(kStart_ns + 33'000'000LL * static_cast<std::int64_t>(frame)));
    };
    FoundRun run = add_run("full", kFrames, SE3{});
    run.record.config = {{"loops.mode", std::string("final"), "the test"}};
    run.record.final_metrics = run.record.metrics;
    run.record.final_metrics->ate.value->stats = statistics(std::vector<double>{0.0012});
    loop_error::LoopError error;
    error.sharp = {7, 5};
    error.blurred = {3, 1};
    error.oracle_ate_m = 0.0007;
    run.record.loops = Outcome<loop_error::LoopError>{error, {}};
    const auto folder = run.folder.lexically_relative(folder_);
    write(folder / "record.json", to_json(run.record));
    write(folder / "final.tum", tum_text(circle(kFrames)));
    std::string table = "query_s,place_s,tx_m,ty_m,tz_m,qx,qy,qz,qw,verified_by,decision,why\n" + stamp(40) +
                        "," + stamp(10) + ",0.1,0,0,0,0,0,1,features,accepted,\"agrees\"\n" + stamp(50) +
                        "," + stamp(10) + ",0.1,0,0,0,0,0,1,depth,accepted,\"agrees\"\n";
    for (std::size_t i = 0; i < refused; ++i)
      table += stamp(20) + "," + stamp(i % 10) + ",0,0,0,0,0,0,1,nothing,refused,\"too few, by far\"\n";
    write(folder / "loops.csv", table);
    write(folder / "places.csv", "timestamp_s,blur_px,candidates,accepted\n" + stamp(10) + ",0.5,0,0\n" +
                                     stamp(20) + ",2,8,0\n" + stamp(40) + ",3,1,1\n" + stamp(50) +
                                     ",4,1,1\n");
    return run;
  }
};

TEST_F(LoopsPageTest, LoopsAreLinesBetweenFinalPoses) {
  const FoundRun run = add_run_with_loops(3);
  const RunSeries series = series_of(run, "full");
  EXPECT_TRUE(series.warnings.empty());
  const auto views = loop_view_charts(series, 200);
  ASSERT_EQ(views.size(), 3U);
  const ChartSeries& loops = series_of_chart(views, "x-z view with loops: full", "accepted loops (2)");
  EXPECT_EQ(loops.style, SeriesStyle::segments);
  EXPECT_FALSE(loops.on_request);
  ASSERT_EQ(loops.points.size(), 4U);
  const Trajectory poses = circle(kFrames);
  for (const auto& [point, frame] : {std::pair{0, 10}, {1, 40}, {2, 10}, {3, 50}}) {
    const Vector3d& p = poses[static_cast<std::size_t>(frame)].T_world_camera.translation;
    EXPECT_NEAR((loops.points[static_cast<std::size_t>(point)] - Vector2d(p.x(), p.z())).norm(), 0, 1e-6);
  }
  const ChartSeries& refused = series_of_chart(views, "x-y view with loops: full", "refused, others (3)");
  EXPECT_TRUE(refused.on_request);
  EXPECT_EQ(refused.points.size(), 6U);
  const std::string script = gnuplot_script(views[0], "view.svg", FigureFormat::svg);
  EXPECT_EQ(script.find("refused, others"), std::string::npos);
  EXPECT_NE(script.find("accepted loops"), std::string::npos);

  const auto times = loop_time_charts(series, 200);
  EXPECT_EQ(series_of_chart(times, "Candidates for loops: full", "accepted by depth alone (1)").points.size(),
            1U);
  EXPECT_NEAR(series_of_chart(times, "Candidates for loops: full", "accepted by features (1)").points[0].y(),
              0.33, 1e-5);
  EXPECT_EQ(series_of_chart(times, "Motion blur of the places: full", "with a loop (2)").points.size(), 2U);
  for (const Vector2d& point :
       series_of_chart(times, "Position error before and after: full", "before (online)").points)
    EXPECT_NEAR(point.y(), 2, 1e-6);
  for (const Vector2d& point :
       series_of_chart(times, "Position error before and after: full", "after (final)").points)
    EXPECT_NEAR(point.y(), 0, 1e-6);
  for (const Vector2d& point :
       series_of_chart(times, "How far the poses moved: full", "final against online").points)
    EXPECT_NEAR(point.y(), 0, 1e-6);  // all alike
}

TEST_F(LoopsPageTest, ManyRefusedCandidatesAreThinnedOut) {
  const FoundRun run = add_run_with_loops(1000);
  const auto views = loop_view_charts(series_of(run, "full"), 100);
  EXPECT_EQ(series_of_chart(views, "x-y view with loops: full", "refused, others (1000, one in 10 drawn)")
                .points.size(),
            200U);
}

TEST_F(LoopsPageTest, ThePageHasTheNumbersOfLoopsAndBothKindsOfPoses) {
  add_run_with_loops(3);
  const auto runs = find_runs(folder_ / "runs");
  ASSERT_TRUE(runs.has_value());
  const ResultsPage result = results_page(*runs, "Circles");
  EXPECT_TRUE(result.warnings.empty());
  const std::string html = to_html(result.page);
  for (const char* const part : {"Loops and final poses", "Trajectories with loops", "Loops over time",
                                 "<td>5 of 7</td><td>1 of 3</td>", "<td>1.00</td><td>0.12</td><td>0.07</td>",
                                 "<td>online</td>", "<td>final</td>"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_LT(
      std::ranges::find(result.page.sections, "Systems", &PageSection::title) - result.page.sections.begin(),
      static_cast<std::ptrdiff_t>(result.tables));
}

TEST_F(LoopsPageTest, OfASystemWithLoopsOfItsOwnTheModeIsNotThatOfTheFilter) {
  FoundRun run = add_run("elasticfusion", kFrames, SE3{});
  run.record.config = {{"system.method", std::string("elasticfusion"), "the test"},
                       {"loops.mode", std::string("off"), "the test"}};
  run.record.final_metrics = run.record.metrics;
  write(run.folder.lexically_relative(folder_) / "final.tum", tum_text(circle(kFrames)));
  const std::string html = to_html(results_page({run}, "t").page);
  EXPECT_NE(html.find("<td>its own</td>"), std::string::npos);
}

TEST_F(ResultsPageTest, WithoutLoopsOrOtherSystemsNothingIsSaidOfThem) {
  FoundRun run = add_run("full", kFrames, SE3{});
  run.record.config = {{"system.method", std::string("filter"), "the test"}};
  const std::string html = to_html(results_page({run}, "t").page);
  for (const char* const part : {"loops", "Loops", "Systems"})
    EXPECT_EQ(html.substr(0, html.find("<script")).find(part), std::string::npos) << part;
}

TEST_F(ResultsPageTest, APageHoldsAllRunsAndSaysWhatItCouldNotRead) {
  add_run("full", kFrames, SE3{});
  const FoundRun damaged = add_run("dm", kFrames, SE3{});
  add_run("no-imu", 30, SE3{});
  write("runs/circle/dm/01234567/frames.csv", "frame,timestamp\n0\n");
  const auto runs = find_runs(folder_ / "runs");
  ASSERT_TRUE(runs.has_value());
  const ResultsPage result = results_page(*runs, "Circles");
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("frames.csv:2"), std::string::npos) << result.warnings[0];
  const std::string html = to_html(result.page);
  for (const char* const part :
       {"Circles", "lost at the end", "2 of 3 runs ok", "Trajectories", "Models", "ground truth"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_LT(html.size(), 3'000'000U);
}

}  // namespace
}  // namespace fusebench
