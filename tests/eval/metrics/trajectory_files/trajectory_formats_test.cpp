#include "eval/metrics/trajectory_files/trajectory_formats.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include "eval/metrics/trajectory_files/trajectory_pair.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace trajectory;
using namespace trajectory_files;

namespace {

class TrajectoryFormats : public ::testing::Test {
 protected:
  Result<LoadedTrajectory> load(std::string_view text, Duplicates duplicates = Duplicates::none,
                                std::optional<TrajectoryFormat> format = {},
                                std::optional<io::TimeUnit> unit = {}) {
    const auto file = folder_.path() / "trajectory.txt";
    std::ofstream(file, std::ios::binary) << text;
    warnings_.clear();
    return load_trajectory(file, {format, unit, duplicates}, warnings_);
  }

  void expect_refused(std::string_view text, std::string_view part) {
    const auto loaded = load(text);
    ASSERT_FALSE(loaded.has_value()) << text;
    EXPECT_EQ(loaded.error().code, ErrorCode::data_corrupt);
    EXPECT_NE(loaded.error().message.find(part), std::string::npos) << loaded.error().message;
  }

  testing::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

constexpr std::string_view kQuarterTurnKitti =
    "1 0 0 0 0 1 0 0 0 0 1 0\n"
    "0 -1 0 1.5 1 0 0 -2 0 0 1 0.25\n";

TEST_F(TrajectoryFormats, ColumnsTellTheFormat) {
  const auto tum = load("# comment\n\n1305031102.1758 1 2 3 0 0 0 1\n1305031102.2 1 2 3 0 0 0 1\n");
  ASSERT_TRUE(tum.has_value()) << tum.error().message;
  EXPECT_EQ(tum->format, TrajectoryFormat::tum);
  EXPECT_EQ(tum->poses[0].timestamp_ns, 1305031102175800000);

  const auto euroc = load("#timestamp [ns], p_x\n1403636579763555584,1,2,3,0.5,-0.5,0.5,0.5\n");
  ASSERT_TRUE(euroc.has_value()) << euroc.error().message;
  EXPECT_EQ(euroc->format, TrajectoryFormat::euroc);
  EXPECT_EQ(euroc->poses[0].timestamp_ns, 1403636579763555584) << "no digit goes through a double";
  EXPECT_NEAR(euroc->poses[0].T_world_camera.rotation.w(), 0.5, 1e-15) << "w comes first";
  EXPECT_NEAR(euroc->poses[0].T_world_camera.rotation.x(), -0.5, 1e-15);

  const auto state = load("1403636579763555584,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n");
  ASSERT_TRUE(state.has_value()) << state.error().message;
  EXPECT_EQ(state->format, TrajectoryFormat::euroc);

  const auto kitti = load(kQuarterTurnKitti);
  ASSERT_TRUE(kitti.has_value()) << kitti.error().message;
  EXPECT_EQ(kitti->format, TrajectoryFormat::kitti);
  EXPECT_FALSE(kitti->has_stamps());
  EXPECT_TRUE(kitti->poses[1].T_world_camera.translation.isApprox(Vector3d(1.5, -2, 0.25)));
  EXPECT_TRUE((kitti->poses[1].T_world_camera.rotation * Vector3d::UnitX()).isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(warnings_.empty());

  expect_refused("1 2 3 4\n", ":1: 4 columns are no trajectory");
  expect_refused("# nothing\n", "has no rows");
}

TEST_F(TrajectoryFormats, TumTextIsNoGroundTruthOfEuroc) {
  const auto file = folder_.write("est.txt", "# comment\n0.1 1 2 3 0 0 0 1\n0.2 1 2 3 0 0 0 1\n");
  const auto refused = load_trajectory(file, {TrajectoryFormat::euroc}, warnings_);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(refused.error().message.find("est.txt:2: no commas"), std::string::npos)
      << refused.error().message;
  EXPECT_NE(refused.error().hint.find("say tum"), std::string::npos) << refused.error().hint;
}

TEST_F(TrajectoryFormats, UnitsOfStampsAreFoundByTheirSizeOrTold) {
  const auto stamp_of = [&](std::string_view stamp, std::optional<io::TimeUnit> unit = {}) {
    const auto loaded =
        load(std::string(stamp) + " 1 2 3 0 0 0 1\n", Duplicates::none, TrajectoryFormat::tum, unit);
    EXPECT_TRUE(loaded.has_value()) << loaded.error().message;
    return loaded ? loaded->poses[0].timestamp_ns : 0;
  };
  constexpr std::int64_t kStamp_ns = 1305031102175304000;
  EXPECT_EQ(stamp_of("1305031102.175304"), kStamp_ns);
  EXPECT_TRUE(warnings_.empty());
  for (const auto& [stamp, name] :
       {std::pair{"1305031102175.304", ":1: stamps are read as milliseconds, by their size"},
        {"1305031102175304", "microseconds"},
        {"1305031102175304000", "nanoseconds"},
        {"1.305031102175304000e+18", "nanoseconds"}}) {
    EXPECT_EQ(stamp_of(stamp), kStamp_ns) << stamp;
    ASSERT_EQ(warnings_.size(), 1U) << stamp;
    EXPECT_NE(warnings_[0].find(name), std::string::npos) << warnings_[0];
  }
  EXPECT_EQ(stamp_of("5000000", io::TimeUnit::nanoseconds), 5'000'000) << "told";
  EXPECT_EQ(stamp_of("5", io::TimeUnit::milliseconds), 5'000'000);
  EXPECT_TRUE(warnings_.empty()) << "nothing was guessed";
  for (const auto unit :
       {io::TimeUnit::milliseconds, io::TimeUnit::microseconds, io::TimeUnit::nanoseconds}) {
    EXPECT_EQ(stamp_of("10.050000", unit), 10'050'000'000) << "decimals are of seconds in one of two files";
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("read as seconds"), std::string::npos) << warnings_[0];
  }
  EXPECT_EQ(stamp_of("1305031102175.304", io::TimeUnit::milliseconds), kStamp_ns) << "by its size";

  const auto blanks = load("1403636579763555584 1 2 3 0.5 0.5 0.5 -0.5\n");
  ASSERT_TRUE(blanks.has_value()) << blanks.error().message;
  EXPECT_EQ(blanks->format, TrajectoryFormat::tum) << "EuRoC's files have commas";
  EXPECT_EQ(blanks->poses[0].timestamp_ns, 1403636579763555584);
  EXPECT_FALSE(parse_stamp_unit("min").has_value());
}

/// A quarter turn about x, w last.
void expect_quarter_turn(const LoadedTrajectory& loaded) {
  EXPECT_NEAR(loaded.poses[0].T_world_camera.rotation.x(), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(loaded.poses[0].T_world_camera.rotation.w(), std::sqrt(0.5), 1e-6);
  EXPECT_EQ(loaded.poses[0].T_world_camera.translation, Vector3d(1, 2, 3));
}

constexpr std::string_view kNamedLikeTum =
    "#ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw\n1403636579763555584,1,2,3,0.70710678,0,0,0.70710678\n";
constexpr std::string_view kUnnamedEuroc = "1403636579763555584,1,2,3,0.70710678,0.70710678,0,0\n";

TEST_F(TrajectoryFormats, NamesGoBeforeTheGivenFormatAndTheColumns) {
  for (const auto format : {std::optional<TrajectoryFormat>(), std::optional(TrajectoryFormat::tum),
                            std::optional(TrajectoryFormat::euroc), std::optional(TrajectoryFormat::kitti)}) {
    const auto loaded = load(kNamedLikeTum, Duplicates::none, format);
    ASSERT_TRUE(loaded) << loaded.error().message;
    expect_quarter_turn(*loaded);
    EXPECT_EQ(loaded->format, TrajectoryFormat::tum);
    EXPECT_EQ(loaded->format_source, "names in line 1");
    EXPECT_EQ(loaded->poses[0].timestamp_ns, 1403636579763555584);
    const bool contradicts = format && *format != TrajectoryFormat::tum;
    EXPECT_EQ(warnings_.size(), contradicts ? 1U : 0U);
  }
  const auto named = load("t,x,y,z,qw,qx,qy,qz\n1.5,1,2,3,0.70710678,0.70710678,0,0\n");
  ASSERT_TRUE(named) << named.error().message;
  expect_quarter_turn(*named);
  EXPECT_EQ(named->format, TrajectoryFormat::euroc) << "w first";
  EXPECT_EQ(named->poses[0].timestamp_ns, 1'500'000'000) << "decimals are no nanoseconds";
  EXPECT_TRUE(warnings_.empty()) << "nobody said nanoseconds: " << warnings_[0];
}

TEST_F(TrajectoryFormats, TheGivenFormatGoesBeforeTheColumns) {
  const auto given = load(kUnnamedEuroc, Duplicates::none, TrajectoryFormat::euroc);
  ASSERT_TRUE(given) << given.error().message;
  expect_quarter_turn(*given);
  EXPECT_EQ(given->format_source, "as given");
  const auto as_tum = load(kUnnamedEuroc, Duplicates::none, TrajectoryFormat::tum);
  ASSERT_TRUE(as_tum);
  EXPECT_EQ(as_tum->poses[0].T_world_camera.rotation.w(), 0);
  const auto small = load("5,1,2,3,0.70710678,0.70710678,0,0\n", Duplicates::none, TrajectoryFormat::euroc);
  ASSERT_TRUE(small);
  expect_quarter_turn(*small);
  EXPECT_EQ(small->poses[0].timestamp_ns, 5) << "nanoseconds of the format";
}

TEST_F(TrajectoryFormats, WithEurocAnEstimateMayBeTumTextWithoutCommas) {
  const auto load_estimate = [&](std::string_view text) {
    TrajectoryReading reading{TrajectoryFormat::euroc};
    reading.tum_without_commas = true;
    warnings_.clear();
    return load_trajectory(folder_.write("est.txt", text), reading, warnings_);
  };
  const auto blanks = load_estimate("1.5 1 2 3 0.70710678 0 0 0.70710678\n");
  ASSERT_TRUE(blanks) << blanks.error().message;
  expect_quarter_turn(*blanks);
  EXPECT_EQ(blanks->format, TrajectoryFormat::tum);
  const auto commas = load_estimate("1403636579.5,1,2,3,0.70710678,0.70710678,0,0\n");
  ASSERT_TRUE(commas) << commas.error().message;
  expect_quarter_turn(*commas);
  EXPECT_EQ(commas->format, TrajectoryFormat::euroc)
      << "as given, although it looks like TUM text with commas";
  EXPECT_EQ(commas->poses[0].timestamp_ns, 1403636579500000000);
}

TEST_F(TrajectoryFormats, MoreColumnsAndCommasAtTheEnd) {
  for (const char* more :
       {"", ",", ",0.1,0.2,0.3", ",0.1,0.2,0.3,", ",0.1,0.2,0.3,0.4", ",1,2,3,4,5,6,7,8,9,10,11,12"}) {
    for (const auto format : {std::optional<TrajectoryFormat>(), std::optional(TrajectoryFormat::euroc)}) {
      const std::string row(kUnnamedEuroc.substr(0, kUnnamedEuroc.size() - 1));
      const auto loaded = load(row + more + "\n", Duplicates::none, format);
      ASSERT_TRUE(loaded) << more << ": " << loaded.error().message;
      expect_quarter_turn(*loaded);
      EXPECT_EQ(loaded->format, TrajectoryFormat::euroc) << more;
      EXPECT_EQ(warnings_.size(), std::string_view(more).size() > 1 ? 1U : 0U) << more;
    }
  }
  ASSERT_TRUE(load("1403636579763555584,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n"));
  EXPECT_TRUE(warnings_.empty()) << "velocity and biases of EuRoC";
  const auto id = load("#timestamp x y z qx qy qz qw id\n1403636579.5 1 2 3 0.70710678 0 0 0.70710678 1\n");
  ASSERT_TRUE(id) << id.error().message;
  expect_quarter_turn(*id);
  EXPECT_TRUE(warnings_.empty());
  for (const int columns : {9, 10, 12, 13, 16, 17, 19}) {
    std::string row = "1403636579.5 1 2 3 0.70710678 0 0 0.70710678";
    for (int i = 8; i < columns; ++i) row += " 7.5";
    const auto loaded = load(row + "\n");
    ASSERT_TRUE(loaded) << columns << ": " << loaded.error().message;
    expect_quarter_turn(*loaded);
    ASSERT_EQ(warnings_.size(), 1U) << columns;
    EXPECT_NE(warnings_[0].find(std::to_string(columns - 8) + " columns after the first 8 are not used"),
              std::string::npos)
        << warnings_[0];
  }
}

constexpr std::string_view kQuarterTurn = "0 -1 0 1.5 1 0 0 -2 0 0 1 0.25";

void expect_kitti_quarter_turn(const LoadedTrajectory& loaded, std::size_t pose) {
  EXPECT_EQ(loaded.format, TrajectoryFormat::kitti);
  ASSERT_GT(loaded.poses.size(), pose);
  const SE3& T = loaded.poses[pose].T_world_camera;
  EXPECT_TRUE(T.translation.isApprox(Vector3d(1.5, -2, 0.25)));
  EXPECT_TRUE((T.rotation * Vector3d::UnitX()).isApprox(Vector3d::UnitY()));
}

TEST_F(TrajectoryFormats, MatricesAfterAStampOrANumber) {
  constexpr std::string_view kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0";
  for (const std::string& last : {std::string(), std::string(" 0 0 0 1")}) {
    for (const auto format : {std::optional<TrajectoryFormat>(), std::optional(TrajectoryFormat::kitti)}) {
      const auto rows = [&](std::string_view first, std::string_view second) {
        return std::string(first) + " " + std::string(kIdentity) + last + "\n" + std::string(second) + " " +
               std::string(kQuarterTurn) + last + "\n";
      };
      const auto stamped = load(rows("1305031102.5", "1305031102.75"), Duplicates::none, format);
      ASSERT_TRUE(stamped) << stamped.error().message;
      expect_kitti_quarter_turn(*stamped, 1);
      EXPECT_TRUE(stamped->has_stamps());
      EXPECT_EQ(stamped->poses[1].timestamp_ns, 1305031102750000000);
      EXPECT_TRUE(warnings_.empty());
      const auto nanoseconds =
          load(rows("1305031102500000000", "1305031102750000000"), Duplicates::none, format);
      ASSERT_TRUE(nanoseconds) << nanoseconds.error().message;
      EXPECT_EQ(nanoseconds->poses[1].timestamp_ns, 1305031102750000000);
      const auto numbered = load(rows("2", "4.0e+00"), Duplicates::none, format);
      ASSERT_TRUE(numbered) << numbered.error().message;
      expect_kitti_quarter_turn(*numbered, 1);
      EXPECT_TRUE(numbered->has_numbers());
      EXPECT_EQ(numbered->poses[1].timestamp_ns, 4);
      EXPECT_NE(numbered->format_source.find("after the number of the frame"), std::string::npos);
      const auto told = load(rows("2", "4"), Duplicates::none, format, io::TimeUnit::milliseconds);
      ASSERT_TRUE(told) << told.error().message;
      EXPECT_EQ(told->poses[1].timestamp_ns, 4'000'000);
    }
  }
  expect_refused("1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2\n", ":1: 17 columns are no trajectory");
  expect_refused("1403636579.5 1 2 3 4 5 6 7 8 9\n", ":1: 10 columns are no trajectory");
}

TEST_F(TrajectoryFormats, TransposedMatricesAreReadWithAWarning) {
  const auto loaded = load("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n0 1 0 0 -1 0 0 0 0 0 1 0 1.5 -2 0.25 1\n");
  ASSERT_TRUE(loaded) << loaded.error().message;
  expect_kitti_quarter_turn(*loaded, 1);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("matrices are transposed"), std::string::npos) << warnings_[0];
  const auto numbered = load("0 0 1 0 0 -1 0 0 0 0 0 1 0 1.5 -2 0.25 1\n");
  ASSERT_TRUE(numbered) << numbered.error().message;
  expect_kitti_quarter_turn(*numbered, 0);
  const auto mixed = load("0 -1 0 1.5 1 0 0 -2 0 0 1 0.25 0 0 0 1\n0 1 0 0 -1 0 0 0 0 0 1 0 1.5 -2 0.25 1\n",
                          Duplicates::none, TrajectoryFormat::kitti);
  ASSERT_FALSE(mixed);
  EXPECT_NE(mixed.error().hint.find("transposed"), std::string::npos) << mixed.error().hint;
}

TEST_F(TrajectoryFormats, LostFramesOfMatricesKeepTheNumbersOfOthers) {
  const std::string lost = "nan nan nan nan nan nan nan nan nan nan nan nan\n";
  const auto loaded = load("1 0 0 0 0 1 0 0 0 0 1 0\n" + lost + std::string(kQuarterTurn) + "\n");
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->poses.size(), 2U);
  EXPECT_TRUE(loaded->has_numbers()) << "there is a gap";
  EXPECT_EQ(loaded->poses[1].timestamp_ns, 2);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":2: 1 of 3 poses are of lost frames"), std::string::npos) << warnings_[0];
  const auto whole =
      load("1 0 0 0 0 1 0 0 0 0 1 0\n" + std::string(kQuarterTurn) + "\n" + std::string(kQuarterTurn) + "\n");
  ASSERT_TRUE(whole);
  const auto pair = pair_up(whole->poses, loaded->poses, {AssociationRule::number});
  ASSERT_TRUE(pair);
  ASSERT_EQ(pair->size(), 2U);
  EXPECT_EQ(pair->reference[1].timestamp_ns, 2);
  EXPECT_FALSE(load(lost)) << "no pose at all";
}

TEST_F(TrajectoryFormats, MatricesAreNotReadAsQuaternionsWhateverIsTyped) {
  for (const auto format : {TrajectoryFormat::tum, TrajectoryFormat::openvins}) {
    for (const char* before : {"", "1305031102.5 "}) {
      const auto refused = load(before + std::string(kQuarterTurn) + "\n", Duplicates::none, format);
      ASSERT_FALSE(refused) << before;
      EXPECT_NE(refused.error().message.find("are the matrix of a pose"), std::string::npos)
          << refused.error().message;
      EXPECT_NE(refused.error().hint.find("say kitti"), std::string::npos) << refused.error().hint;
    }
  }
}

TEST_F(TrajectoryFormats, StampsMayBeInTwoColumns) {
  constexpr std::string_view kRows =
      "1305031102 900000000 1 2 3 0.70710678 0 0 0.70710678\n1305031102 933000000 1 2 3 0.70710678 0 0 "
      "0.70710678\n";
  for (const auto format : {std::optional<TrajectoryFormat>(), std::optional(TrajectoryFormat::tum)}) {
    const auto loaded = load(kRows, Duplicates::none, format);
    ASSERT_TRUE(loaded) << loaded.error().message;
    expect_quarter_turn(*loaded);
    EXPECT_EQ(loaded->poses[1].timestamp_ns, 1305031102933000000);
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("seconds and nanoseconds in two columns"), std::string::npos) << warnings_[0];
  }
}

TEST_F(TrajectoryFormats, WholeMatricesAreKitti) {
  const auto whole =
      load("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n0 -1 0 1.5 1 0 0 -2 0 0 1 0.25 0.0 0.0 0.0 1.0\n");
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(whole->format, TrajectoryFormat::kitti);
  EXPECT_TRUE(whole->poses[1].T_world_camera.translation.isApprox(Vector3d(1.5, -2, 0.25)));
  const auto refused = load("1 0 0 5 0 1 0 0 0 0 1 0 0 0 1 1\n", Duplicates::none, TrajectoryFormat::kitti);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(":1: the last row of the pose is 0 0 1 1"), std::string::npos)
      << refused.error().message;
}

TEST_F(TrajectoryFormats, OneGivenUnitIsOfTheFilesThatCanBeInIt) {
  constexpr auto kNanoseconds = io::TimeUnit::nanoseconds;
  const auto estimate =
      load("12345678901 1 2 3 0 0 0 1\n", Duplicates::none, TrajectoryFormat::tum, kNanoseconds);
  ASSERT_TRUE(estimate) << estimate.error().message;
  EXPECT_EQ(estimate->poses[0].timestamp_ns, 12'345'678'901);
  EXPECT_TRUE(warnings_.empty());
  // The first stamp may be a whole number of seconds.
  constexpr std::string_view kSeconds = "12 1 2 3 0 0 0 1\n12.345678901 1 2 3 0 0 0 1\n";
  const auto reference = load(kSeconds, Duplicates::none, TrajectoryFormat::tum, kNanoseconds);
  ASSERT_TRUE(reference) << reference.error().message;
  EXPECT_EQ(reference->poses[1].timestamp_ns, 12'345'678'901);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("stamps such as 12.345678901 are no nanoseconds: read as seconds"),
            std::string::npos)
      << warnings_[0];
  TrajectoryReading strict{TrajectoryFormat::tum, io::TimeUnit::milliseconds};
  strict.unit_of_this_file = true;
  const auto milliseconds =
      load_trajectory(folder_.write("ms.txt", "12.345678901 1 2 3 0 0 0 1\n"), strict, warnings_);
  ASSERT_TRUE(milliseconds);
  EXPECT_EQ(milliseconds->poses[0].timestamp_ns, 12'345'679);
  const auto named = load("# t[us] x y z qx qy qz qw\n5 1 2 3 0 0 0 1\n", Duplicates::none, {}, kNanoseconds);
  ASSERT_TRUE(named);
  EXPECT_EQ(named->poses[0].timestamp_ns, 5000) << "names go before what is given";
  EXPECT_EQ(warnings_.size(), 1U);
}

TEST_F(TrajectoryFormats, LostFramesLeaveCovariancesAligned) {
  const std::string covariance = " 1 0 0 1 0 1 1 0 0 1 0 1\n";
  const auto loaded = load("1 0 0 0 0 0 0 1" + covariance + "2 nan nan nan nan nan nan nan" + covariance +
                           "3 0 0 0 0 0 0 0 nan nan nan nan nan nan nan nan nan nan nan nan\n"
                           "4 9 0 0 0 0 0 1 4 0 0 4 0 4 5 0 0 5 0 5\n");
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->poses.size(), 2U);
  ASSERT_EQ(loaded->covariances.size(), 2U);
  EXPECT_EQ(loaded->poses[1].timestamp_ns, 4'000'000'000);
  EXPECT_EQ(loaded->covariances[1].orientation_rad2(0, 0), 4);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":2: 2 of 4 rows are of lost frames"), std::string::npos) << warnings_[0];

  const std::string named =
      "# timestamp(s) tx ty tz qx qy qz qw Pr11 Pr12 Pr13 Pr22 Pr23 Pr33 Pt11 Pt12 Pt13 Pt22 Pt23 Pt33\n";
  const auto with_names = load(named + "1 0 0 0 0 0 0 1" + covariance);
  ASSERT_TRUE(with_names) << with_names.error().message;
  EXPECT_EQ(with_names->format, TrajectoryFormat::openvins);
  const auto others = load("# t x y z qx qy qz qw a b c d e f g h i j k l\n1 0 0 0 0 0 0 1" + covariance);
  ASSERT_TRUE(others) << others.error().message;
  EXPECT_EQ(others->format, TrajectoryFormat::tum) << "columns that are named otherwise are no covariances";
}

TEST_F(TrajectoryFormats, KittiTextReadsBack) {
  const auto kitti = load(kQuarterTurnKitti);
  ASSERT_TRUE(kitti.has_value());
  EXPECT_EQ(kitti_text(kitti->poses).substr(0, 24), "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto again = load(kitti_text(kitti->poses));
  ASSERT_TRUE(again.has_value()) << again.error().message;
  EXPECT_EQ(again->format, TrajectoryFormat::kitti);
  EXPECT_TRUE(again->poses[1].T_world_camera.translation == kitti->poses[1].T_world_camera.translation);
  EXPECT_LT(
      rotation_angle_rad(again->poses[1].T_world_camera.rotation, kitti->poses[1].T_world_camera.rotation),
      1e-12);
}

TEST_F(TrajectoryFormats, MatricesBecomeRotationsOrAreRefused) {
  const auto rounded = load("1.0002 0 0 0 0 1 0 0 0 0 1 0\n");
  ASSERT_TRUE(rounded.has_value());
  EXPECT_NEAR(rounded->poses[0].T_world_camera.rotation.norm(), 1.0, 1e-15);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":1: rotations are off orthonormal by up to 0.0004"), std::string::npos)
      << warnings_[0];
  expect_refused("1.1 0 0 0 0 1 0 0 0 0 1 0\n", ":1: the 3x3 part is no rotation");
  expect_refused("1 0 0 0 0 1 0 0 0 0 -1 0\n", "determinant -1");
  expect_refused("0 0 0 0 0 0 0 0 0 0 0 0\n", "no rotation");
}

TEST_F(TrajectoryFormats, QuaternionsAreNormalisedAndCounted) {
  const auto loaded = load("1 0 0 0 0 0 0 1.01\n2 0 0 0 0 0 0 1.0001\n");
  ASSERT_TRUE(loaded.has_value());
  EXPECT_NEAR(loaded->poses[0].T_world_camera.rotation.norm(), 1.0, 1e-15);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":1: 1 of 2 quaternions are off unit length"), std::string::npos)
      << warnings_[0];
  expect_refused("1 0 0 0 0 0 0 1e-9\n", ":1: quaternion");
}

TEST_F(TrajectoryFormats, OrderAndRepeatedStamps) {
  constexpr std::string_view kRepeated = "1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n2 3 0 0 0 0 0 1\n";
  expect_refused(kRepeated, ":3: the stamp is the same as that of line 2");
  EXPECT_EQ(load(kRepeated, Duplicates::first)->poses.back().T_world_camera.translation.x(), 2);
  EXPECT_EQ(load(kRepeated, Duplicates::last)->poses.back().T_world_camera.translation.x(), 3);
  EXPECT_EQ(load(kRepeated, Duplicates::as_written)->poses.size(), 3U);

  std::string rare = "0 0 0 0 0 0 0 1\n";
  for (int i = 0; i < 200; ++i) rare += std::to_string(i) + " 1 0 0 0 0 0 1\n";
  EXPECT_EQ(load(rare, Duplicates::rare_kept)->poses.size(), 201U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":2: 1 of 201 rows repeat a stamp (both are kept)"), std::string::npos);
  const auto last = load(rare, Duplicates::rare_last);
  EXPECT_EQ(last->poses.size(), 200U);
  EXPECT_EQ(last->poses[0].T_world_camera.translation.x(), 1);
  EXPECT_FALSE(load(kRepeated, Duplicates::rare_kept).has_value()) << "one in three is not rare";

  const auto sorted = load("3 3 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  ASSERT_TRUE(sorted.has_value());
  EXPECT_EQ(sorted->poses.front().timestamp_ns, 1000000000);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("not in order of time (sorted)"), std::string::npos);
}

TEST_F(TrajectoryFormats, TwoTrajectoriesInOneFileAreNotWovenTogether) {
  std::string text;
  for (int run = 0; run < 2; ++run) {
    for (int i = 0; i < 20; ++i) text += std::to_string(i) + (run == 0 ? ".0" : ".5") + " 0 0 0 0 0 0 1\n";
  }
  expect_refused(text, ":21: time jumps back by 18.500 s: the file seems to hold 2 trajectories");
}

}  // namespace
}  // namespace fusebench
