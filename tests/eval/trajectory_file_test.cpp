#include "eval/trajectory_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace fusebench {
namespace {

class TrajectoryFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    file_ = std::filesystem::temp_directory_path() /
            (std::string("fusebench_trajectory_") + test->name() + ".txt");
  }
  void TearDown() override { std::filesystem::remove(file_); }
  Result<Trajectory> read(const std::string& text, Duplicates duplicates = Duplicates::error) {
    std::ofstream(file_) << text;
    return read_tum_trajectory(file_, duplicates);
  }
  std::filesystem::path file_;
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

TEST_F(TrajectoryFile, ErrorsNameTheLine) {
  const auto expect_line = [&](const std::string& text, int line) {
    const auto result = read(text);
    ASSERT_FALSE(result.has_value()) << text;
    EXPECT_EQ(result.error().code, ErrorCode::data_corrupt);
    EXPECT_TRUE(result.error().message.starts_with(file_.string() + ":" + std::to_string(line) + ":"))
        << result.error().message;
  };
  expect_line("# header\n1.0 0 0 0 0 0 0 1\n2.0 0 0 0 0 0 1\n", 3);
  expect_line("1.0 0 0 0 0 0 0 1 9\n", 1);
  expect_line("1.0 0 nan 0 0 0 0 1\n", 1);
  expect_line("1.0 0 0 0 0 0 0 0\n", 1);
  expect_line("\n1.0 0 0 0x 0 0 0 1\n", 2);
  expect_line("1.0 0 0 0 0 0 0 1\n1.0 1 0 0 0 0 0 1\n", 2);
}

TEST_F(TrajectoryFile, SortsAndKeepsTheDuplicateAskedFor) {
  const std::string text = "2.0 5 0 0 0 0 0 1\n1.0 1 0 0 0 0 0 1\n1.0 2 0 0 0 0 0 2\n";
  EXPECT_EQ((*read(text, Duplicates::first))[0].T_world_camera.translation.x(), 1);
  EXPECT_EQ((*read(text, Duplicates::last))[0].T_world_camera.translation.x(), 2);
  EXPECT_EQ((*read(text, Duplicates::last))[1].T_world_camera.translation.x(), 5);
}

}  // namespace
}  // namespace fusebench
