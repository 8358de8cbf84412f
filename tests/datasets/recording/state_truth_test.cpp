#include "datasets/recording/state_truth.hpp"

#include <gtest/gtest.h>

#include "datasets/open_recording.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"

namespace fusebench {

using namespace filter;
using namespace calibration;
using namespace recording;
using namespace datasets;

namespace {

constexpr const char* kHeader = "#timestamp [ns],p_RS_R_x [m],and so on\n";
constexpr const char* kRow = "10000000000,1,2,3,0.5,0.5,-0.5,0.5,4,5,6,0.1,0.2,0.3,0.4,0.5,0.6\n";

class StateTruth : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const auto states = read_state_truth(write("state_groundtruth.csv", text));
    if (states) return "was not refused";
    EXPECT_EQ(states.error().code, ErrorCode::data_corrupt);
    return states.error().message;
  }
};

TEST_F(StateTruth, ReadsTheColumnsOfEuroc) {
  const auto states = read_state_truth(write("a.csv", std::string(kHeader) + kRow));
  ASSERT_TRUE(states.has_value()) << states.error().message;
  ASSERT_EQ(states->size(), 1U);
  const StampedState& at = states->front();
  EXPECT_EQ(at.timestamp_ns, 10'000'000'000);
  EXPECT_EQ(at.state.T_world_imu.translation, Vector3d(1, 2, 3));
  EXPECT_EQ(at.state.T_world_imu.rotation.w(), 0.5);
  EXPECT_EQ(at.state.T_world_imu.rotation.y(), -0.5);
  EXPECT_EQ(at.state.velocity_world_mps, Vector3d(4, 5, 6));
  EXPECT_EQ(at.state.gyroscope_bias_radps, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(at.state.accelerometer_bias_mps2, Vector3d(0.4, 0.5, 0.6));
}

TEST_F(StateTruth, DamageIsNamedByLine) {
  const std::string good = std::string(kHeader) + kRow;
  EXPECT_NE(refusal(good + "10000000001,1,2\n").find("state_groundtruth.csv:3"), std::string::npos);
  EXPECT_NE(refusal(good + kRow).find(":3"), std::string::npos);  // the same stamp again
  EXPECT_NE(refusal("1,1,2,3,0,0,0,0,4,5,6,0,0,0,0,0,0\n").find("quaternion"), std::string::npos);
  EXPECT_NE(refusal("1,1,2,3,0,0,0,nan,4,5,6,0,0,0,0,0,0\n").find(":1"), std::string::npos);
  EXPECT_NE(refusal(kHeader), "was not refused");
  EXPECT_EQ(read_state_truth(folder_ / "none.csv").error().code, ErrorCode::data_missing);
}

TEST(ExactTruth, LiesBesideARecordingOfAnyFormat) {
  const testing::TumFolder folder;
  OpenOptions options;
  options.read.camera = CalibratedCamera{{0, 0, 10, 11, 3.5, 2.5}, {}, {}};
  const auto without = open_recording(folder.path(), options);
  ASSERT_TRUE(without.has_value()) << without.error().message;
  EXPECT_TRUE(without->state_truth.empty());
  EXPECT_TRUE(without->truth_mesh_file.empty());
  folder.write("state_groundtruth.csv", std::string(kHeader) + kRow);
  folder.write("scene.ply", "is not opened here");
  const auto with = open_recording(folder.path(), options);
  ASSERT_TRUE(with.has_value()) << with.error().message;
  EXPECT_EQ(with->state_truth.size(), 1U);
  EXPECT_EQ(with->truth_mesh_file, folder.path() / "scene.ply");
  EXPECT_EQ(with->fingerprint, without->fingerprint);  // the estimator never sees the truth
  folder.write("state_groundtruth.csv", "what is this\n");
  EXPECT_EQ(open_recording(folder.path(), options).error().code, ErrorCode::data_corrupt);
}

}  // namespace
}  // namespace fusebench
