// Numbers that are finite and impossible: a single one of them would carry through all that follows.
#include "datasets/recording/sensor_columns.hpp"

#include <gtest/gtest.h>

#include <array>

#include "datasets/recording/formats/tum/tum_lists.hpp"
#include "datasets/recording/formats/zr300/zr300_lists.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/state_truth.hpp"
#include "tests/datasets/malformed_text.hpp"

namespace fusebench {

using namespace io;
using namespace recording;
using namespace reading;
using namespace formats::tum;
using namespace formats::zr300;

namespace {

namespace fs = std::filesystem;
using testing::expect_refusal;
using testing::TemporaryFolder;

/// A table with inertial samples: its rows, in which one number is exchanged.
struct InertialTable {
  std::string file;
  std::string columns;  ///< names of those behind the time
  Result<void> (*read)(const fs::path& folder);
};

void PrintTo(const InertialTable& table, std::ostream* stream) { *stream << table.file; }

template <auto kRead>
Result<void> into_recording(const fs::path& folder) {
  Recording recording;
  return kRead(folder, recording);
}

Result<void> read_accelerometer(const fs::path& folder) {
  std::vector<std::string> warnings;
  const auto samples = read_tum_accelerometer(folder / "accelerometer.txt", warnings);
  return samples ? Result<void>{} : tl::unexpected(samples.error());
}

Result<void> read_eth3d(const fs::path& folder) {
  const auto samples = read_imu_table(folder / "imu.txt", TimeUnit::seconds);
  return samples ? Result<void>{} : tl::unexpected(samples.error());
}

class InertialRange : public ::testing::TestWithParam<InertialTable> {
 protected:
  /// Reads six rows, 5 ms apart; in the third, the number of one column (from 0) is this.
  [[nodiscard]] Result<void> read_with(std::size_t column, std::string_view value) const {
    std::string text = "# a comment\n";
    for (int i = 0; i < 6; ++i) {
      text += time_of(i);
      for (std::size_t c = 0; c < names().size(); ++c)
        text += i == 2 && c == column ? fmt::format(" {}", value) : std::string(" 0.5");
      text += "\n";
    }
    folder_.write(table_.file, text);
    return table_.read(folder_.path());
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string_view> fields;
    split_fields(table_.columns, fields);
    return {fields.begin(), fields.end()};
  }

  const InertialTable& table_ = GetParam();
  TemporaryFolder folder_;

 private:
  [[nodiscard]] std::string time_of(int row) const {
    const bool in_seconds = table_.file == "imu.txt" || table_.file == "accelerometer.txt";
    return in_seconds ? fmt::format("{:.3f}", 1 + 0.005 * row)
                      : std::to_string(1'000'000'000 + 5'000'000 * row);
  }
};

TEST_P(InertialRange, NoSensorMeasuresMore) {
  if (table_.file == "GYRO.txt" || table_.file == "ACCEL.txt") {
    folder_.write(table_.file == "GYRO.txt" ? "ACCEL.txt" : "GYRO.txt",
                  "1000000000 0 1 2\n1010000000 0 1 2\n1020000000 0 1 2\n1030000000 0 1 2\n");
  }
  for (std::size_t column = 0; column < names().size(); ++column) {
    const std::string name = names()[column];
    const bool gyroscope = name.starts_with('w') || name.starts_with('g');
    const std::string_view most = gyroscope ? "200" : "2000";
    const auto sound = read_with(column, most);
    EXPECT_TRUE(sound) << sound.error().message;
    for (const char* value : {"-2000.5", "4e9", "1e20", "-3e38", "1e308"}) {
      const auto refused = read_with(column, value);
      ASSERT_FALSE(refused) << name << " = " << value;
      EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
      expect_refusal(refused.error(), folder_.path() / table_.file, 4,
                     fmt::format("{} = {:g} {} (allowed -{} .. {})", name, std::stod(value),
                                 gyroscope ? "rad/s" : "m/s^2", most, most));
      EXPECT_FALSE(refused.error().hint.empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, InertialRange,
    ::testing::Values(InertialTable{"imu.csv", "wx wy wz ax ay az", into_recording<read_imu_beside>},
                      InertialTable{"imu.txt", "wx wy wz ax ay az", read_eth3d},
                      InertialTable{"IMU.txt", "gx gy gz ax ay az", into_recording<read_zr300_imu>},
                      InertialTable{"GYRO.txt", "gx gy gz", into_recording<read_zr300_gyro_and_accel>},
                      InertialTable{"ACCEL.txt", "ax ay az", into_recording<read_zr300_gyro_and_accel>},
                      InertialTable{"accelerometer.txt", "ax ay az", read_accelerometer}),
    [](const auto& test) {
      std::string name = test.param.file;
      std::ranges::replace(name, '.', '_');
      return name;
    });

TEST(TruthRange, PositionsAreOnEarth) {
  const TemporaryFolder folder;
  const auto read = [&](std::string_view x) {
    Recording recording;
    recording.frames.resize(1);
    recording.frames[0].timestamp_ns = 1'200'000'000;
    folder.write("groundtruth.txt", fmt::format("1.0 0 0 0 0 0 0 1\n1.1 {} 2 3 0 0 0 1\n"
                                                "1.3 0 0 0 0 0 0 1\n",
                                                x));
    return read_ground_truth_beside(folder.path(), recording);
  };
  EXPECT_TRUE(read("5.5e6")) << "a northing of UTM";
  for (const char* far : {"-1.1e7", "1e11"}) {
    const auto refused = read(far);
    ASSERT_FALSE(refused) << far;
    expect_refusal(
        refused.error(), folder.path() / "groundtruth.txt", 0,
        fmt::format("the pose at time 1.100000000 has position ({:g}, 2, 3) m (allowed", std::stod(far)));
  }
}

TEST(TruthRange, StatesAreThoseOfAHand) {
  const TemporaryFolder folder;
  constexpr std::array<std::string_view, 12> kNames = {"px",  "py",  "pz",  "vx",  "vy",  "vz",
                                                       "bwx", "bwy", "bwz", "bax", "bay", "baz"};
  for (std::size_t changed = 0; changed < kNames.size(); ++changed) {
    std::string row = "10000000000";
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      row += i == changed ? ",-1e20" : ",0.5";
      if (i == 2) row += ",1,0,0,0";
    }
    const auto states = read_state_truth(folder.write("state_groundtruth.csv", row + "\n"));
    ASSERT_FALSE(states) << kNames[changed];
    expect_refusal(states.error(), folder.path() / "state_groundtruth.csv", 1,
                   fmt::format("{} = -1e+20 ", kNames[changed]));
  }
}

}  // namespace
}  // namespace fusebench
