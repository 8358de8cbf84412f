#include "core/base/trajectory/trajectory_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace trajectory;

namespace {

class TrajectoryFile : public testing::InTemporaryFolder {
 protected:
  Result<Trajectory> read(const std::string& text, Duplicates duplicates = Duplicates::error) {
    warnings_.clear();
    return read_tum_trajectory(write(file_.filename(), text), warnings_, duplicates);
  }
  std::filesystem::path file_ = folder_ / "trajectory.txt";
  std::vector<std::string> warnings_;
};

TEST_F(TrajectoryFile, WritesWhatItReads) {
  Trajectory path(3);
  for (std::size_t i = 0; i < 3; ++i) {
    path[i].timestamp_ns = 1305031102175304123 + static_cast<std::int64_t>(i);
    path[i].T_world_camera = {so3_exp({0.1 / 3.0, -0.7, 0.2 * static_cast<double>(i)}),
                              {1.0 / 3.0, -1e-17, 12345.678901234567}};
  }
  const auto back = read(tum_text(path));
  ASSERT_TRUE(back.has_value()) << back.error().message;
  ASSERT_EQ(back->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*back)[i].timestamp_ns, path[i].timestamp_ns);
    EXPECT_EQ((*back)[i].T_world_camera.translation, path[i].T_world_camera.translation);
    EXPECT_LT(rotation_angle_rad((*back)[i].T_world_camera.rotation, path[i].T_world_camera.rotation), 1e-15);
  }
}

TEST_F(TrajectoryFile, StampsHaveNineDecimals) {
  EXPECT_EQ(stamp_text(1305031102175304123), "1305031102.175304123");
  EXPECT_EQ(stamp_text(5), "0.000000005");
  EXPECT_EQ(stamp_text(-1500000000), "-1.500000000");
}

TEST_F(TrajectoryFile, PublishedTruthMayRepeatAStampButNotRunBackwards) {
  const auto repeated = read("1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0 1\n2.0 5 0 0 0 0 0 1\n3.0 2 0 0 0 0 0 1\n",
                             Duplicates::last_in_order);
  ASSERT_TRUE(repeated.has_value());
  ASSERT_EQ(repeated->size(), 3U);
  EXPECT_EQ((*repeated)[1].T_world_camera.translation.x(), 5.0);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("1 of 4 rows repeat a stamp"), std::string::npos) << warnings_[0];

  const auto backwards =
      read("1.0 0 0 0 0 0 0 1\n3.0 1 0 0 0 0 0 1\n2.0 5 0 0 0 0 0 1\n", Duplicates::last_in_order);
  ASSERT_FALSE(backwards.has_value());
  EXPECT_NE(backwards.error().message.find(":3: time runs backwards"), std::string::npos);
}

/// Their distances would be no numbers, and every error of the trajectory.
TEST_F(TrajectoryFile, PositionsBeyondAnyUnitAreRefused) {
  EXPECT_TRUE(read("1 1e12 0 -1e12 0 0 0 1\n2 0 0 0 0 0 0 1\n").has_value());
  for (const char* position : {"1e308 0 0", "0 -1e13 0", "0 0 1.1e12"}) {
    const auto refused = read("1 0 0 0 0 0 0 1\n2 " + std::string(position) + " 0 0 0 1\n");
    ASSERT_FALSE(refused) << position;
    EXPECT_NE(refused.error().message.find("trajectory.txt:2: position "), std::string::npos)
        << refused.error().message;
  }
}

TEST_F(TrajectoryFile, ErrorsNameTheLine) {
  const auto expect_line = [&](const std::string& text, int line, std::string_view what) {
    const auto result = read(text);
    ASSERT_FALSE(result.has_value()) << text;
    EXPECT_EQ(result.error().code, ErrorCode::data_corrupt);
    EXPECT_TRUE(result.error().message.starts_with(file_.string() + ":" + std::to_string(line) + ":"))
        << result.error().message;
    EXPECT_NE(result.error().message.find(what), std::string::npos) << result.error().message;
  };
  expect_line("# header\n1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 1\n", 3,
              "expected 8 columns: timestamp tx ty tz qx qy qz qw, got 7");
  expect_line("1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 0 1 9\n", 2, "got 9");
  expect_line("1.0 0 0 0 0 0 1\n", 1, "expected 8 columns or more");
  expect_line("1.0 0 inf 0 0 0 0 1\n", 1, "ty: expected a finite number");
  expect_line("1.0 0 nan 0 0 0 0 inf\n", 1, "qw: expected a finite number");
  expect_line("1.0 0 0 0 0 0 0 1e-9\n", 1, "quaternion");
  expect_line("nan 0 0 0 0 0 0 1\n", 1, "timestamp: expected a time");
  expect_line("\n1.0 0 0 0x 0 0 0 1\n", 2, "tz: expected a finite number");
  expect_line("1.0 0 0 0 0 0 0 1\n1.0 1 0 0 0 0 0 1\n", 2, "is the same as that of line 1");
  expect_line("2.0 0 0 0 0 0 0 1\n1.0 1 0 0 0 0 0 1\n", 2, "time runs backwards by 1 s");
  expect_line("noon 0 0 0 0 0 0 1\n", 1, "timestamp: expected a time");
}

TEST_F(TrajectoryFile, SortsAndKeepsTheDuplicateAskedFor) {
  const std::string text = "2.0 5 0 0 0 0 0 1\n1.0 1 0 0 0 0 0 1\n1.0 2 0 0 0 0 0 2\n";
  EXPECT_EQ((*read(text, Duplicates::first))[0].T_world_camera.translation.x(), 1);
  EXPECT_EQ((*read(text, Duplicates::last))[0].T_world_camera.translation.x(), 2);
  EXPECT_EQ((*read(text, Duplicates::last))[1].T_world_camera.translation.x(), 5);
}

TEST_F(TrajectoryFile, DisorderIsTold) {
  ASSERT_TRUE(read("1.0 1 0 0 0 0 0 1\n1.0 2 0 0 0 0 0 1\n", Duplicates::last));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0], file_.string() + ":2: 1 of 2 rows repeat a stamp (the last one is kept)");
  ASSERT_TRUE(read("2.0 1 0 0 0 0 0 1\n1.0 2 0 0 0 0 0 1\n", Duplicates::first));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("not in order of time"), std::string::npos) << warnings_[0];
  ASSERT_TRUE(read("1.0 1 0 0 0 0 0 1\n2.0 2 0 0 0 0 0 1\n", Duplicates::last));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(TrajectoryFile, QuaternionsAreNormalisedAndLongOnesCounted) {
  const auto path = read("1 0 0 0 0 0 0 1.0005\n2 0 0 0 0 0 0 0.9\n3 0 0 0 1 1 1 1\n");
  ASSERT_TRUE(path) << path.error().message;
  for (const StampedPose& pose : *path) EXPECT_NEAR(pose.T_world_camera.rotation.norm(), 1, 1e-15);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(warnings_[0].starts_with(file_.string() + ":2: 2 of 3 quaternions")) << warnings_[0];
}

TEST_F(TrajectoryFile, RowsOfLostFramesAreLeftOutAndCounted) {
  const auto path = read(
      "1 0 0 0 0 0 0 1\n2 nan nan nan nan nan nan nan\n2 0 0 0 0 0 0 0\n3 1 2 -NaN 0 0 0 1\n4,,,,,,,\n"
      "5 9 9 9 0 0 0 1\n");
  ASSERT_TRUE(path) << path.error().message;
  ASSERT_EQ(path->size(), 2U) << "a stamp that lost frames repeat is no error";
  EXPECT_EQ((*path)[1].timestamp_ns, 5'000'000'000);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":2: 4 of 6 rows are of lost frames (a number is missing"), std::string::npos)
      << warnings_[0];
  const auto others = read(
      "1,0,0,0,0,0,0,1\n2,null,null,null,null,null,null,null\n3,0,0,0,,,,\n4,-1.#IND,0,0,0,0,0,1\n"
      "5,1,1,1,1.#QNAN,0,0,1\n6,0,0,0,NA,NA,NA,NA\n\"7\",\"0\",\"0\",\"0\",\"0\",\"0\",\"0\",\"1\"\n");
  ASSERT_TRUE(others) << others.error().message;
  ASSERT_EQ(others->size(), 2U);
  EXPECT_EQ((*others)[1].timestamp_ns, 7'000'000'000) << "in quotes";
  EXPECT_FALSE(read("1 0 0 0 0 0 0 1\n2 nan 0 0 0 0 0 x\n")) << "a word that no program writes for a number";
  const auto none = read("1 0 0 0 0 0 0 0\n2 nan 0 0 0 0 0 1\n");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find(":1: all 2 rows are of lost frames"), std::string::npos);
}

TEST_F(TrajectoryFile, MoreColumnsAreCountedUnlessTheyAreNamed) {
  EXPECT_TRUE(read("1 0 0 0 0 0 0 1 7\n2 0 0 0 0 0 0 1 8\n"));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0], file_.string() + ":1: 1 columns after the first 8 are not used");
  EXPECT_TRUE(read("#timestamp x y z qx qy qz qw id\n1 0 0 0 0 0 0 1 7\n"));
  EXPECT_TRUE(warnings_.empty());
  EXPECT_TRUE(read("1,0,0,0,0,0,0,1,\n2,0,0,0,0,0,0,1,\n")) << "a comma at the end is no column";
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(TrajectoryFile, NamesSayWhichColumnsAreWhich) {
  for (const char* hash : {"", "# ", "%"}) {
    const auto path =
        read(std::string(hash) + "index,time,qw,qx,qy,qz,tx,ty,tz\n0,1.5,0.5,-0.5,0.5,0.5,1,2,3\n");
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_EQ((*path)[0].timestamp_ns, 1'500'000'000);
    EXPECT_EQ((*path)[0].T_world_camera.translation, Vector3d(1, 2, 3));
    EXPECT_NEAR((*path)[0].T_world_camera.rotation.w(), 0.5, 1e-15);
    EXPECT_NEAR((*path)[0].T_world_camera.rotation.x(), -0.5, 1e-15);
  }
  const auto comment = read("# t x of the camera, qx qy\n# made at 10:30, w of q is last\n1 1 2 3 0 0 0 1\n");
  ASSERT_TRUE(comment) << comment.error().message;
  EXPECT_EQ((*comment)[0].T_world_camera.translation.x(), 1);
  const auto longer = read("# these are timestamp tx ty tz qw qx qy qz\n1 1 2 3 0 0 0 1\n");
  ASSERT_TRUE(longer) << longer.error().message;
  EXPECT_EQ((*longer)[0].T_world_camera.rotation.w(), 1) << "ten words are no names of eight columns";
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find(":1: 10 names of columns, but line 2 has 8 columns"), std::string::npos)
      << warnings_[0];
  const auto last = read("# t x y z qw qx qy qz\n# t x y z qx qy qz qw\n1 1 2 3 0 0 0 1\n");
  ASSERT_TRUE(last);
  EXPECT_EQ((*last)[0].T_world_camera.rotation.w(), 1) << "the line above the rows counts";
}

TEST_F(TrajectoryFile, LinesOfNamesThatDoNotNameAPoseAreErrors) {
  const auto expect_refused = [&](const std::string& text, std::string_view part) {
    const auto refused = read(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
    EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().hint.find("put # before"), std::string::npos) << refused.error().hint;
  };
  expect_refused("# c\nt,tx,ty,tz,q0,q1,q2,q3\n1,0,0,0,0,0,0,1\n",
                 ":2: a line of names, but no column is named as the x of the quaternion (qx)");
  expect_refused("a,b,c,d,e,f,g,h\n1,0,0,0,0,0,0,1\n",
                 ":1: a line of names, but no column is named as the stamp");
  expect_refused("t x y z qx qy qz qw\n1 1 0 0 0 0 0 0 1\n", ":2: 9 columns, but line 1 has 8 names");
}

TEST_F(TrajectoryFile, NamedUnitsUnlessStampsContradictThem) {
  const auto stamp_of = [&](const std::string& text) {
    const auto path = read(text);
    EXPECT_TRUE(path) << path.error().message;
    return path ? (*path)[0].timestamp_ns : 0;
  };
  EXPECT_EQ(stamp_of("# timestamp[ns] tx ty tz qx qy qz qw\n12345 0 0 0 0 0 0 1\n"), 12345);
  EXPECT_EQ(stamp_of("t_us,tx,ty,tz,qx,qy,qz,qw\n12345,0,0,0,0,0,0,1\n"), 12'345'000);
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ(stamp_of("# timestamp[ns] tx ty tz qx qy qz qw\n1403636579.5 0 0 0 0 0 0 1\n"),
            1403636579500000000);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(
      warnings_[0].find(":1: the stamps are named as nanoseconds, which 1403636579.5 cannot be: read as "
                        "seconds"),
      std::string::npos)
      << warnings_[0];
  EXPECT_EQ(stamp_of("# timestamp[s] tx ty tz qx qy qz qw\n1403636579500000000 0 0 0 0 0 0 1\n"),
            1403636579500000000);
  EXPECT_EQ(warnings_.size(), 1U);
  const auto millimetres = read("# t tx[mm] ty[mm] tz[mm] qx qy qz qw\n1 1000 2000 0 0 0 0 1\n");
  ASSERT_TRUE(millimetres);
  EXPECT_EQ((*millimetres)[0].T_world_camera.translation, Vector3d(1, 2, 0));
  EXPECT_EQ(warnings_.size(), 1U) << "positions that are changed are reported";
}

TEST_F(TrajectoryFile, StampsInTwoColumns) {
  constexpr std::string_view kRows =
      "12 900000000 1 2 3 0 0 0 1\n12 930000000 1 2 3 0 0 0 1\n13 5 1 2 3 0 0 0 1\n";
  for (const char* names : {"", "# sec nanosec tx ty tz qx qy qz qw\n"}) {
    const auto path = read(std::string(names) + std::string(kRows));
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_EQ((*path)[1].timestamp_ns, 12'930'000'000);
    EXPECT_EQ((*path)[2].timestamp_ns, 13'000'000'005);
    EXPECT_EQ((*path)[0].T_world_camera.translation, Vector3d(1, 2, 3));
    EXPECT_EQ(warnings_.size(), *names == 0 ? 1U : 0U) << "what was guessed is reported";
  }
  const auto twice = read("time[s],time[ns],x,y,z,qx,qy,qz,qw\n12,12000000000,1,2,3,0,0,0,1\n");
  ASSERT_FALSE(twice) << "the same stamp in two units";
  EXPECT_NE(twice.error().message.find(":2: the stamp is in two columns, 12 and 12000000000"),
            std::string::npos)
      << twice.error().message;
  static_cast<void>(read("0 100 1 2 3 0 0 0 1\n1 200 1 2 3 0 0 0 1\n"));
  for (const std::string& warning : warnings_)
    EXPECT_EQ(warning.find("two columns"), std::string::npos) << "a number and a stamp: " << warning;
}

TEST_F(TrajectoryFile, StampsOutOfRangeNameTheOption) {
  const auto refused = read("12345678901 0 0 0 0 0 0 1\n");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().hint.find("--stamp_unit"), std::string::npos) << refused.error().hint;
}

TEST_F(TrajectoryFile, DecimalCommasAreNamed) {
  for (const char* row :
       {"1403636579,763556,0,05,2,1,0,1,0,1,0,5,0,5,0,5\n",
        "\"1403636579,7\",\"0,1\",\"2,1\",\"0,1\",\"0,05\",\"0,5\",\"0,5\",\"0,5\"\n",
        "1403636579,763556 0,554494 2,064888 3,347873 0,136532 0,020477 0,538971 0,830933\n",
        "1403636579,763556 0 0 0 0 0 0 1\n", "1,5;0,5;2,0;3,3;0,1;0,0;0,5;0,8\n"}) {
    const auto refused = read(row);
    ASSERT_FALSE(refused) << row;
    EXPECT_NE(refused.error().message.find(":1: decimal commas"), std::string::npos)
        << refused.error().message;
    EXPECT_NE(refused.error().hint.find("decimal point"), std::string::npos) << refused.error().hint;
  }
}

TEST_F(TrajectoryFile, MissingAndEmptyFiles) {
  EXPECT_EQ(read_tum_trajectory(folder_ / "none.txt", warnings_).error().code, ErrorCode::data_missing);
  const auto empty = read("# only a comment\n");
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(empty.error().message.find("has no rows"), std::string::npos);
}

}  // namespace
}  // namespace fusebench
