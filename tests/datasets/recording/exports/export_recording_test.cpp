#include "datasets/recording/exports/export_recording.hpp"

#include <gtest/gtest.h>

#include "datasets/open_recording.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace exports;
using testing::expect_contains;
using testing::made_recording;

namespace {

class EveryFormat : public testing::InTemporaryFolder, public ::testing::WithParamInterface<ExportFormat> {
 protected:
  /// Of the size that all formats take.
  static recording::Recording whole() { return made_recording(640, 480, 2); }
  /// Nothing is in the folder, not even hidden.
  void expect_nothing_written() const { EXPECT_TRUE(std::filesystem::is_empty(folder_)); }
};

TEST_P(EveryFormat, SameRecordingGivesTheSameBytes) {
  recording::Recording recording = whole();
  testing::add_made_imu(recording);
  for (const char* name : {"first", "second"}) {
    const auto done = export_recording(recording, GetParam(), folder_ / name / "room");
    ASSERT_TRUE(done) << done.error().message;
  }
  const auto first = testing::files_below(folder_ / "first");
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(first, testing::files_below(folder_ / "second"));
}

TEST_P(EveryFormat, SummaryNamesFilesThatAreThere) {
  const std::filesystem::path out = folder_ / "new" / "room";
  const auto done = export_recording(whole(), GetParam(), out);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->format, GetParam());
  EXPECT_EQ(done->out, out);
  EXPECT_EQ(done->frames, 2);
  EXPECT_FALSE(done->notes.empty());
  ASSERT_FALSE(done->files.empty());
  const std::filesystem::path base = std::filesystem::is_directory(out) ? out : out.parent_path();
  for (const std::filesystem::path& file : done->files) {
    const bool is_mask = file.string().find('%') != std::string::npos;
    EXPECT_TRUE(is_mask || std::filesystem::exists(base / file)) << file;
  }
}

TEST_P(EveryFormat, CountsDepthThatItCannotStore) {
  const auto done = export_recording(whole(), GetParam(), folder_ / "room");
  ASSERT_TRUE(done) << done.error().message;
  // Of 40 m, 70 m, 0.05 mm and 20 m in each of two frames.
  const double farthest_m = done->depth_storage.farthest_m();
  const std::uint64_t lost = 2 + (farthest_m < 40) + (farthest_m < 20);
  EXPECT_EQ(done->depth.beyond_range, 2 * lost);
  // Every fifth pixel has none.
  EXPECT_EQ(done->depth.measured, 2 * (640 * 480 - 640 * 480 / 5));
}

TEST_P(EveryFormat, ErrorInTheMiddleLeavesNothing) {
  recording::Recording recording = whole();
  recording.load_frame = [load = recording.load_frame](std::size_t k) -> Result<RgbdFrame> {
    if (k == 1) return fail(ErrorCode::data_corrupt, "frame 1 is damaged");
    return load(k);
  };
  const auto done = export_recording(recording, GetParam(), folder_ / "new" / "room");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "frame 1 is damaged");
  expect_nothing_written();
}

TEST_P(EveryFormat, ReplacesNothing) {
  const std::filesystem::path out = write("room", "precious");
  const auto done = export_recording(whole(), GetParam(), out);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
  expect_contains(done.error().message, "room: exists already");
  expect_contains(done.error().hint, "--out");
  EXPECT_EQ(testing::files_below(folder_), (std::map<std::string, std::string>{{"room", "precious"}}));
}

TEST_P(EveryFormat, SimulatedDataKeepTheirLabel) {
  recording::Recording recording = whole();
  const bool is_sens = GetParam() == ExportFormat::sens;
  for (const bool simulated : {false, true}) {
    recording.simulated = simulated;
    const std::filesystem::path out =
        folder_ / (simulated ? "made" : "seen") / (is_sens ? "room.sens" : "room");
    const auto done = export_recording(recording, GetParam(), out);
    ASSERT_TRUE(done) << done.error().message;
    const bool is_folder = std::filesystem::is_directory(out);
    const std::filesystem::path label =
        is_folder ? out / "simulation.toml" : out.parent_path() / "room.simulation.toml";
    EXPECT_EQ(std::filesystem::exists(label), simulated);
    if (simulated) expect_contains(testing::read_bytes(label), "simulated recording made");
    if (!datasets::recognise_format(out)) continue;  // only other programs read it
    const auto read = datasets::open_recording(out);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->simulated, simulated);
  }
}

TEST_P(EveryFormat, RefusesARecordingWithoutFrames) {
  const auto done = export_recording(made_recording(640, 480, 0), GetParam(), folder_ / "room");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::usage);
  expect_contains(done.error().message, "no frames");
  expect_nothing_written();
}

TEST_P(EveryFormat, RefusesStampsThatDoNotRise) {
  recording::Recording recording = whole();
  recording.frames[1].timestamp_ns = recording.frames[0].timestamp_ns;
  const auto done = export_recording(recording, GetParam(), folder_ / "room");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::data_corrupt);
  expect_contains(done.error().message, "frames 0 and 1 have stamps 1000.000000000 and 1000.000000000");
  expect_nothing_written();
}

INSTANTIATE_TEST_SUITE_P(All, EveryFormat,
                         ::testing::Values(ExportFormat::tum, ExportFormat::infinitam, ExportFormat::klg,
                                           ExportFormat::sens, ExportFormat::open3d, ExportFormat::euroc),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

TEST(ExportFormatName, IsReadAndRefused) {
  for (const std::string_view name : export_format_names()) {
    const auto format = parse_export_format(name);
    ASSERT_TRUE(format);
    EXPECT_EQ(to_string(*format), name);
  }
  const auto unknown = parse_export_format("euroq");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "format = euroq (allowed tum, infinitam, klg, sens, open3d, euroc)");
  EXPECT_EQ(unknown.error().hint, "did you mean euroc?");
}

TEST(QuantisedDepth, RoundsToTheNearestUnitAndCountsTheRest) {
  DepthImage depth_m(7, 1);
  depth_m.data = {0, 1.0004F, 1.0006F, 2.0F, 2.001F, 0.0004F, std::numeric_limits<float>::quiet_NaN()};
  DepthCounts counts;
  const auto values = quantise_depth(depth_m, {1000, 2000}, counts);
  EXPECT_EQ(values.data, (std::vector<std::uint16_t>{0, 1000, 1001, 2000, 0, 0, 0}));
  EXPECT_EQ(counts.measured, 5);
  EXPECT_EQ(counts.beyond_range, 2);
}

}  // namespace
}  // namespace fusebench
