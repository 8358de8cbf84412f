// Whole runs over the five golden frames.
#include "eval/run/run.hpp"
#include "core/config/config_access.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include "core/base/io/text_table.hpp"
#include "core/base/mesh/ply_file.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "core/config/variants.hpp"
#include "core/estimator/health/stage_times.hpp"
#include "eval/metrics/intensity_file.hpp"
#include "eval/suites/engine/local_engine.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/trace_events.hpp"

namespace fusebench {

using namespace io;
using namespace config;
using namespace trajectory;
using namespace mesh;
using namespace filter;
using namespace health;
using namespace recording;
using namespace metrics;
using namespace record;
using namespace run;
using namespace engine;

namespace {

const std::filesystem::path kGolden = testing::golden_tum_folder();

class RunTest : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] RunSpec spec(const std::string& variant, int threads = 1) const {
    RunSpec result;
    result.recording = kGolden;
    result.variant = variant;
    result.config = variant_config(*find_variant(variant));
    result.threads = threads;
    result.out = folder_ / ("out" + std::to_string(threads));
    return result;
  }
};

/// The part of a record before the timing.
std::string reproducible_part(const std::string& record) {
  return record.substr(0, record.find("\"timing\""));
}

TEST_F(RunTest, WritesAWholeFolder) {
  const auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value()) << prepared.error().message;
  std::size_t frames_seen = 0;
  const auto record = execute_run(*prepared, {[&](std::size_t frame, std::size_t) { frames_seen = frame; }});
  ASSERT_TRUE(record.has_value()) << record.error().message;
  EXPECT_EQ(record->status, RunStatus::ok) << record->reason;
  EXPECT_EQ(frames_seen, 5U);
  EXPECT_EQ(record->frames.total, 5U);
  for (const char* const name : {"record.json", "trajectory.tum", "truth.tum", "patches.csv", "mesh.ply",
                                 "frames.csv", "states.csv", "intensity.bin", "log.txt"}) {
    EXPECT_TRUE(std::filesystem::exists(prepared->folder / name)) << name;
  }
  EXPECT_EQ(testing::read_bytes(prepared->folder / "record.json"), to_json(*record));
  std::vector<std::string> warnings;
  const auto trajectory = read_tum_trajectory(prepared->folder / "trajectory.tum", warnings);
  ASSERT_TRUE(trajectory.has_value());
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(trajectory->size(), record->frames.tracked);
  // World is the first camera frame.
  EXPECT_EQ((*trajectory)[0].T_world_camera.translation, Vector3d(0, 0, 0));
  EXPECT_EQ((*trajectory)[0].timestamp_ns, prepared->recording.frames[0].timestamp_ns);
  // The files give the table's number.
  const auto truth = read_tum_trajectory(prepared->folder / "truth.tum", warnings);
  ASSERT_TRUE(truth.has_value() && record->metrics.ate.value);
  const auto ate = trajectory_error::absolute_trajectory_error(*truth, *trajectory, {});
  ASSERT_TRUE(ate.has_value()) << ate.error().message;
  EXPECT_NEAR(ate->stats.rmse, record->metrics.ate.value->stats.rmse, 1e-12);
}

TEST_F(RunTest, TheRecordSaysWhatTheTruthIs) {
  std::filesystem::copy(kGolden, folder_ / "freiburg1_walk", std::filesystem::copy_options::recursive);
  RunSpec wanted = spec("no-imu");
  wanted.recording = folder_ / "freiburg1_walk";
  wanted.frames = FrameWindow{0, 2};
  const auto truth_of = [&] {
    const auto prepared = prepare_run(wanted);
    const auto record = prepared ? execute_run(*prepared) : Result<RunRecord>(RunRecord{});
    return record ? record->recording.truth : record.error().message;
  };
  const auto has_file = [&] { return std::filesystem::exists(prepare_run(wanted)->folder / "truth.tum"); };
  EXPECT_EQ(truth_of(), "given");
  EXPECT_TRUE(has_file());
  const std::filesystem::path file = wanted.recording / "groundtruth.txt";
  const std::string given = testing::read_bytes(file);
  std::filesystem::permissions(file, std::filesystem::perms::owner_write, std::filesystem::perm_options::add);
  std::ofstream(file) << "# " << kPseudoGroundTruth << "\n" << given;
  EXPECT_TRUE(kPseudoGroundTruth.starts_with(kPseudoTruthWord));
  EXPECT_EQ(truth_of(), kPseudoTruthWord);
  std::filesystem::remove(file);
  EXPECT_EQ(truth_of(), "none");
  EXPECT_FALSE(has_file()) << "a heading alone is no truth";
}

TEST_F(RunTest, SameBytesWithAnyThreadCount) {
  const auto one = prepare_run(spec("no-imu", 1));
  const auto three = prepare_run(spec("no-imu", 3));
  ASSERT_TRUE(one && three && execute_run(*one) && execute_run(*three));
  EXPECT_EQ(one->folder.filename(), three->folder.filename());
  for (const char* const name :
       {"trajectory.tum", "truth.tum", "states.csv", "mesh.ply", "intensity.bin", "patches.csv", "log.txt"}) {
    EXPECT_EQ(testing::read_bytes(one->folder / name), testing::read_bytes(three->folder / name)) << name;
  }
  EXPECT_EQ(reproducible_part(testing::read_bytes(one->folder / "record.json")),
            reproducible_part(testing::read_bytes(three->folder / "record.json")));
}

/// frames.csv without its last columns, the milliseconds of decoding and of each stage.
std::string without_times(const std::string& table) {
  std::istringstream lines(table);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    for (std::size_t column = 0; column <= kStageNames.size(); ++column) line.erase(line.rfind(','));
    result += line + "\n";
  }
  return result;
}

TEST_F(RunTest, AProfileChangesNothingElse) {
  for (const int threads : {1, 2}) {
    RunSpec profiled_spec = spec("no-imu", threads);
    profiled_spec.profile = true;
    profiled_spec.out = folder_ / fmt::format("profiled{}", threads);
    const auto plain = prepare_run(spec("no-imu", threads));
    const auto profiled = prepare_run(profiled_spec);
    ASSERT_TRUE(plain && profiled && execute_run(*plain) && execute_run(*profiled));
    EXPECT_EQ(plain->run_id, profiled->run_id);
    EXPECT_EQ(plain->folder.filename(), profiled->folder.filename());
    EXPECT_FALSE(std::filesystem::exists(plain->folder / "trace.json"));
    for (const auto& entry : std::filesystem::directory_iterator(profiled->folder)) {
      const std::string name = entry.path().filename().string();
      if (name == "trace.json") continue;
      const std::string before = testing::read_bytes(plain->folder / name);
      const std::string after = testing::read_bytes(entry.path());
      if (name == "record.json") {
        EXPECT_EQ(reproducible_part(before), reproducible_part(after));
      } else if (name == "frames.csv") {
        EXPECT_EQ(without_times(before), without_times(after));
      } else {
        EXPECT_EQ(before, after) << name;
      }
    }
  }
}

TEST_F(RunTest, AProfileSaysWhenEachStageRan) {
  for (const int threads : {1, 2}) {
    RunSpec profiled = spec("no-imu", threads);
    profiled.profile = true;
    const auto prepared = prepare_run(profiled);
    ASSERT_TRUE(prepared.has_value());
    const auto record = execute_run(*prepared);
    ASSERT_TRUE(record.has_value());
    std::vector<std::string> names;
    for (const auto& [name, histogram] : record->timing.histograms) {
      names.push_back(name);
      // The first frame is compared with nothing.
      EXPECT_EQ(histogram.count, name == "update" ? 4U : 5U) << name;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"decode", "preprocess", "predict", "update", "fuse", "refresh",
                                               "frame"}));
    const auto events = testing::complete_events(testing::read_bytes(prepared->folder / "trace.json"));
    EXPECT_TRUE(testing::nest_properly(events));
    for (const testing::TraceEvent& event : events) {
      EXPECT_GE(event.begin_ns, 0);
      EXPECT_EQ(event.thread, threads > 1 && event.name == "decode" ? 2 : 1) << event.name;
    }
    std::istringstream table(testing::read_bytes(prepared->folder / "frames.csv"));
    std::string line;
    std::getline(table, line);
    for (int frame = 0; std::getline(table, line); ++frame) {
      std::vector<std::string> cells;
      std::istringstream cells_of(line);
      for (std::string cell; std::getline(cells_of, cell, ',');) cells.push_back(cell);
      const std::size_t first = cells.size() - kStageNames.size();
      for (std::size_t stage = 0; stage < kStageNames.size(); ++stage) {
        EXPECT_NEAR(testing::time_in_frame_ms(events, std::string(kStageNames[stage]), frame),
                    parse_number(cells[first + stage]).value(), 0.00051)
            << kStageNames[stage] << " of frame " << frame;
      }
    }
  }
}

TEST_F(RunTest, StatesHaveARowAFrame) {
  const auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared && execute_run(*prepared));
  std::istringstream table(testing::read_bytes(prepared->folder / "states.csv"));
  std::vector<std::vector<double>> rows;
  std::vector<std::string_view> fields;
  for (std::string line; std::getline(table, line);) {
    split_fields(line, fields);
    ASSERT_EQ(fields.size(), 2U + 19U + 120U + 2U * filter::kSensorSize);
    if (rows.empty() && fields[0] == "capture_timestamp") continue;
    rows.emplace_back();
    for (std::size_t i = 2; i < fields.size(); ++i) rows.back().push_back(parse_number(fields[i]).value());
  }
  ASSERT_EQ(rows.size(), 5U);
  for (const std::vector<double>& row : rows) {
    EXPECT_NEAR(Eigen::Map<const Eigen::Vector4d>(&row[3]).norm(), 1, 1e-12);
    EXPECT_NEAR(Eigen::Map<const Vector3d>(&row[16]).norm(), 1, 1e-12);
  }
  EXPECT_EQ(rows[0][19], 0);  // the first pose is known
  EXPECT_GT(rows[4][19], 0);
}

TEST_F(RunTest, NeesNeedsTrueStates) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  const auto without = execute_run(*prepared);
  ASSERT_TRUE(without.has_value());
  for (const auto& part : without->metrics.nees) {
    EXPECT_FALSE(part.value.has_value());
    EXPECT_EQ(part.reason, "the recording has no true states");
  }
  EXPECT_EQ(without->metrics.residuals.value->frames, 4U);
  EXPECT_GT(without->metrics.residuals.value->chi2_photometric, 0);

  // This recording's camera is its IMU frame.
  for (const StampedPose& pose : prepared->recording.ground_truth) {
    StampedState state;
    state.timestamp_ns = pose.timestamp_ns;
    state.state.T_world_imu = pose.T_world_camera;
    prepared->recording.state_truth.push_back(state);
  }
  const auto with = execute_run(*prepared);
  ASSERT_TRUE(with.has_value());
  const auto& position = with->metrics.nees[1].value;
  ASSERT_TRUE(position.has_value()) << with->metrics.nees[1].reason;
  EXPECT_EQ(position->part.name, "position");
  EXPECT_EQ(position->stats.count, 4U);
  EXPECT_TRUE(std::isfinite(position->stats.mean));

  prepared->recording.imu_source = ImuSource::synthetic;  // of another body
  EXPECT_NE(execute_run(*prepared)->metrics.nees[1].reason.find("synthetic"), std::string::npos);
}

TEST_F(RunTest, TheMeshIsComparedInTheWorldOfTheTruth) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  const auto without = execute_run(*prepared);
  ASSERT_TRUE(without.has_value());
  EXPECT_EQ(without->metrics.mesh.reason, "the recording has no true mesh");

  // A truth that the run meets exactly: its own mesh, moved to the true first camera.
  auto scene = read_ply(prepared->folder / "mesh.ply");
  ASSERT_TRUE(scene.has_value());
  const Recording& recording = prepared->recording;
  const auto first = interpolate_pose(recording.ground_truth, recording.frames[0].capture_ns, 100'000'000);
  ASSERT_TRUE(first.has_value());
  for (Vector3d& vertex : scene->vertices) vertex = *first * vertex;
  ASSERT_TRUE(write_ply(scene->cast<float>(), folder_ / "scene.ply").has_value());
  prepared->recording.truth_mesh_file = folder_ / "scene.ply";
  const auto with = execute_run(*prepared);
  ASSERT_TRUE(with.has_value());
  const auto& mesh = with->metrics.mesh.value;
  ASSERT_TRUE(mesh.has_value()) << with->metrics.mesh.reason;
  EXPECT_EQ(mesh->first_camera.alignment.mode, "first_camera");
  EXPECT_LT(mesh->first_camera.accuracy.stats.max, 1e-5);
  EXPECT_LT(mesh->first_camera.completeness.stats.max, 1e-5);
  EXPECT_EQ(mesh->poses.alignment.mode, "poses");
  EXPECT_LT(mesh->poses.accuracy.stats.mean, 0.03);  // the real truth's own noise, over five frames
  EXPECT_GT(mesh->truth_observed, mesh->truth_samples / 2);
  EXPECT_EQ(mesh->views, 1U);
  const auto back = read_record(prepared->folder / "record.json");
  ASSERT_TRUE(back && back->metrics.mesh.value);
  EXPECT_EQ(back->metrics.mesh.value->poses.accuracy.p95, mesh->poses.accuracy.p95);
  EXPECT_EQ(back->metrics.mesh.value->truth_observed, mesh->truth_observed);

  write("scene.ply", "ply\nnonsense");
  const auto damaged = execute_run(*prepared);
  ASSERT_TRUE(damaged.has_value());
  EXPECT_EQ(damaged->metrics.mesh.reason, "scene.ply is not a usable mesh");
}

TEST_F(RunTest, AVariantThatNeedsAnImuSaysHowToGetOne) {
  const auto prepared = prepare_run(spec("full"));
  ASSERT_FALSE(prepared.has_value());
  EXPECT_EQ(exit_code(prepared.error().code), 2);
  EXPECT_NE(prepared.error().hint.find("--imu synthetic"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(RunTest, WithoutTruthNoImuIsOfferedThatNeedsOne) {
  const std::filesystem::path copy = folder_ / "freiburg1_walk";
  std::filesystem::copy(kGolden, copy, std::filesystem::copy_options::recursive);
  std::filesystem::remove(copy / "groundtruth.txt");
  RunSpec without = spec("full");
  without.recording = copy;
  const auto prepared = prepare_run(without);
  ASSERT_FALSE(prepared.has_value());
  EXPECT_EQ(prepared.error().hint,
            "--variant no-imu and dm-no-imu do without; there is no ground truth to make an IMU from");
}

TEST_F(RunTest, AnEditedOptionThatNeedsAnImuIsNamedWithItsPlace) {
  RunSpec edited = spec("no-imu");
  ASSERT_TRUE(edited.config.set("terms.prior", std::string("imu"), "mine.toml:12"));
  const auto prepared = prepare_run(edited);
  ASSERT_FALSE(prepared.has_value());
  EXPECT_NE(prepared.error().message.find("mine.toml:12: terms.prior = \"imu\" needs an IMU"),
            std::string::npos)
      << prepared.error().message;
  EXPECT_EQ(prepared.error().hint.find("--variant no-imu needs none"), std::string::npos);
}

TEST(FrameWindow, MayLeaveOutEitherEnd) {
  EXPECT_EQ(to_string(*parse_window(":60")), "0:60");
  EXPECT_EQ(to_string(*parse_window("7:")), "7:");
  for (const char* text : {":0", "::5", ":x", "5"}) EXPECT_FALSE(parse_window(text)) << text;
}

TEST_F(RunTest, TheHashTellsConfigurationsAndWindowsApart) {
  const auto base = prepare_run(spec("no-imu"));
  RunSpec edited = spec("no-imu");
  ASSERT_TRUE(edited.config.set("iekf.max_iterations", std::int64_t{3}, "--set").has_value());
  const auto other_config = prepare_run(edited);
  RunSpec window = spec("no-imu");
  window.frames = FrameWindow{1, 4};
  const auto other_window = prepare_run(window);
  ASSERT_TRUE(base && other_config && other_window);
  EXPECT_NE(base->folder, other_config->folder);
  EXPECT_NE(base->folder, other_window->folder);
  EXPECT_EQ(other_window->recording.frames.size(), 3U);
  // A variant without IMU is the same run whatever IMU was offered.
  RunSpec synthetic = spec("no-imu");
  synthetic.imu = ImuChoice::synthetic;
  EXPECT_EQ(prepare_run(synthetic)->folder, base->folder);
}

TEST_F(RunTest, TheHashTellsSyntheticImusApart) {
  const auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  const auto hash = [&](const std::string& imu_note) {
    Recording recording = prepared->recording;
    recording.imu_note = imu_note;
    return run_identity(prepared->spec, recording);
  };
  EXPECT_EQ(prepared->run_id, hash(prepared->recording.imu_note));
  EXPECT_EQ(prepared->folder.filename().string(), prepared->run_id.substr(0, 8));
  EXPECT_EQ(hash("seed 1").size(), 32U);
  EXPECT_EQ(hash("seed 1"), hash("seed 1"));
  EXPECT_NE(hash("seed 1"), hash("seed 2"));
}

TEST_F(RunTest, NotesOfTheRecordingAreInRecordAndLog) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  const std::string folder = prepared->spec.recording.string();
  prepared->recording.notes = {"rgb.txt: stamps were made regular"};
  prepared->recording.warnings = {folder + "/groundtruth.txt:3: one row", folder + ": no partner", "a gap"};
  const auto record = execute_run(*prepared);
  ASSERT_TRUE(record.has_value()) << record.error().message;
  const std::string& name = prepared->recording.name;
  // The place of the recording on this disk is not part of its record.
  EXPECT_EQ(record->recording.notes,
            (std::vector<std::string>{"rgb.txt: stamps were made regular",
                                      "warning: " + name + "/groundtruth.txt:3: one row",
                                      "warning: " + name + ": no partner", "warning: a gap"}));
  EXPECT_EQ(read_record(prepared->folder / "record.json")->recording.notes, record->recording.notes);
  const std::string log = testing::read_bytes(prepared->folder / "log.txt");
  for (const std::string& note : record->recording.notes) {
    EXPECT_NE(log.find(note + "\n"), std::string::npos) << note;
  }
}

TEST_F(RunTest, AStoppedRunLeavesNothing) {
  const auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  std::atomic<bool> stop = false;
  const auto record =
      execute_run(*prepared, {[&](std::size_t frame, std::size_t) { stop = frame >= 2; }, &stop});
  EXPECT_FALSE(record.has_value());
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(RunTest, AFrameThatCannotBeReadEndsTheRunAsFailed) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  prepared->recording.load_frame =
      [load = prepared->recording.load_frame](std::size_t frame) -> Result<RgbdFrame> {
    if (frame == 3) return fail(ErrorCode::data_corrupt, "image.png: is cut off");
    return load(frame);
  };
  const auto record = execute_run(*prepared);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->status, RunStatus::failed);
  EXPECT_EQ(record->reason, "frame 3: image.png: is cut off");
  EXPECT_EQ(record->frames.tracked + record->frames.lost, 3U);
  EXPECT_TRUE(std::filesystem::exists(prepared->folder / "trajectory.tum"));
  EXPECT_EQ(read_record(prepared->folder / "record.json")->status, RunStatus::failed);

  // Or it is an error with the code that tells bad data from a failed estimator, and changes nothing.
  const auto error = execute_run(*prepared, {.bad_data_is_recorded = false});
  ASSERT_FALSE(error.has_value());
  EXPECT_EQ(error.error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(error.error().message, "frame 3: image.png: is cut off");
  std::filesystem::remove_all(prepared->folder);
  EXPECT_FALSE(execute_run(*prepared, {.bad_data_is_recorded = false}).has_value());
  EXPECT_FALSE(std::filesystem::exists(prepared->folder));
}

TEST_F(RunTest, BlackFramesAreLost) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  ASSERT_TRUE(
      set_option(prepared->spec.config.values(), "iekf.max_lost_frames", std::int64_t{1}).has_value());
  prepared->recording.load_frame =
      [load = prepared->recording.load_frame](std::size_t frame) -> Result<RgbdFrame> {
    auto loaded = load(frame);
    if (loaded && frame >= 2) {
      std::fill(loaded->depth_m.data.begin(), loaded->depth_m.data.end(), 0.0F);
      std::fill(loaded->grey.data.begin(), loaded->grey.data.end(), std::uint8_t{0});
    }
    return loaded;
  };
  const auto record = execute_run(*prepared);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->status, RunStatus::lost);
  EXPECT_TRUE(record->reason.starts_with("lost at frame ")) << record->reason;
  EXPECT_EQ(record->frames.lost, 2U);  // one more than allowed
  // A frame that was lost has a prediction, which is no estimate: it has no pose.
  std::vector<std::string> warnings;
  EXPECT_EQ(read_tum_trajectory(prepared->folder / "trajectory.tum", warnings)->size(),
            record->frames.tracked);
  EXPECT_LT(record->frames.tracked, 5U);
}

/// The recording in the dark before a frame.
void darken_before(Recording& recording, std::size_t first_seen) {
  recording.load_frame = [load = recording.load_frame, first_seen](std::size_t frame) -> Result<RgbdFrame> {
    auto loaded = load(frame);
    if (loaded && frame < first_seen)
      std::fill(loaded->grey.data.begin(), loaded->grey.data.end(), std::uint8_t{0});
    return loaded;
  };
}

TEST_F(RunTest, StartsAtTheFirstUsableFrameAndSaysSo) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  darken_before(prepared->recording, 2);
  const auto record = execute_run(*prepared);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->status, RunStatus::ok) << record->reason;
  EXPECT_EQ(record->frames.tracked, 3U);
  EXPECT_EQ(record->frames.lost, 2U);
  std::vector<std::string> warnings;
  EXPECT_EQ(read_tum_trajectory(prepared->folder / "trajectory.tum", warnings)->size(), 3U);
  std::ostringstream log;
  log << std::ifstream(prepared->folder / "log.txt").rdbuf();
  EXPECT_NE(log.str().find("frame 1: lost: waiting for a usable first frame: dark"), std::string::npos);
  EXPECT_NE(log.str().find("frame 2: started"), std::string::npos) << log.str();
}

TEST_F(RunTest, ARecordingWithoutAUsableFrameIsLost) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  darken_before(prepared->recording, 5);
  const auto record = execute_run(*prepared);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->status, RunStatus::lost);
  EXPECT_EQ(record->frames.tracked, 0U);
  EXPECT_EQ(record->frames.lost, 5U);
}

TEST_F(RunTest, ARunThatHardlyTracksIsLost) {
  auto prepared = prepare_run(spec("no-imu"));
  ASSERT_TRUE(prepared.has_value());
  darken_before(prepared->recording, 4);  // the last frame is a first frame, which is tracked for sure
  const auto lost = execute_run(*prepared);
  ASSERT_TRUE(lost.has_value());
  EXPECT_EQ(lost->status, RunStatus::lost);
  EXPECT_EQ(lost->reason, "only 1 of 5 frames tracked (evaluation.min_tracked_share = 0.25)");
  ASSERT_TRUE(set_option(prepared->spec.config.values(), "evaluation.min_tracked_share", 0.2).has_value());
  const auto ok = execute_run(*prepared);
  ASSERT_TRUE(ok.has_value());
  EXPECT_EQ(ok->status, RunStatus::ok) << ok->reason;
}

/// While it lives, no file can grow beyond 8 kB.
class FullDisk {
 public:
  FullDisk() {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{8192, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

BatchJob job_of(const RunSpec& spec) {
  BatchJob job;
  job.recording = spec.recording;
  job.variant = spec.variant;
  job.spec = spec;
  return job;
}

TEST_F(RunTest, AFullDiskEndsTheEngineAndNotTheRun) {
  const std::vector<BatchJob> jobs = {job_of(spec("no-imu"))};
  const auto good = run_locally(jobs, {});
  ASSERT_TRUE(good.has_value()) << good.error().message;
  ASSERT_EQ(good->front().status, RunStatus::ok);
  const std::string before = testing::read_bytes(good->front().folder / "record.json");
  {
    const FullDisk full_disk;
    const auto bad = run_locally(jobs, {.repeat_finished = true});
    ASSERT_FALSE(bad.has_value());
    EXPECT_EQ(bad.error().code, ErrorCode::io);
    EXPECT_NE(bad.error().message.find("cannot be written"), std::string::npos) << bad.error().message;
  }
  EXPECT_EQ(testing::read_bytes(good->front().folder / "record.json"), before);
}

TEST_F(RunTest, FinishedRunsAreLeftAlone) {
  const std::vector<BatchJob> jobs = {job_of(spec("no-imu"))};
  const auto first = run_locally(jobs, {});
  ASSERT_TRUE(first.has_value()) << first.error().message;
  EXPECT_FALSE(first->front().resumed);
  const auto again = run_locally(jobs, {});
  EXPECT_TRUE(again->front().resumed);
  EXPECT_EQ(again->front().status, RunStatus::ok);
  EXPECT_EQ(again->front().folder, first->front().folder);
  EXPECT_FALSE(run_locally(jobs, {.repeat_finished = true})->front().resumed);
}

}  // namespace
}  // namespace fusebench
