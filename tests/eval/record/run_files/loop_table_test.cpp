#include "eval/record/run_files/loop_table.hpp"

#include <gtest/gtest.h>

#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace run_files;

namespace {

class LoopTable : public testing::InTemporaryFolder {};

// As core/estimator/places/loops/loop_tables.cpp writes it.
constexpr const char* kHeader =
    "query_s,place_s,tx_m,ty_m,tz_m,qx,qy,qz,qw,sigma_rotation_rad,sigma_position_m,dissimilarity,matches,"
    "inliers,consistent_share,violating_share,chi2,verified_by,decision,why\n";

std::string line(const std::string& pose, const std::string& verdict) {
  return "12.500000,1.250000," + pose + ",0.002,0.003,0.65,68,33,0.395,0.023,0.13," + verdict + "\n";
}
constexpr const char* kPose = "0.1,0,0,0,0,0,1";
constexpr const char* kNoPose = "0,0,0,0,0,0,1";

TEST_F(LoopTable, TellsWhyACandidateWasRefused) {
  const auto file =
      write("loops.csv", kHeader + line(kPose, "features,accepted,\"agrees with the poses\"") +
                             line(kPose, "depth,accepted,\"agrees\"") +
                             line(kPose, "tracker,accepted,\"the lost tracker found itself by it\"") +
                             line(kNoPose, "nothing,refused,\"12 matches of features (at least 20)\"") +
                             line(kPose, "nothing,refused,\"9 % of the depth fits (at least 25 %)\"") +
                             line(kPose, "features,refused,\"contradicts the poses, whatever supports it\""));
  const auto rows = read_candidate_table(file);
  ASSERT_TRUE(rows.has_value()) << rows.error().message;
  ASSERT_EQ(rows->size(), 6U);
  EXPECT_EQ((*rows)[0].query_ns, 12'500'000'000);
  EXPECT_EQ((*rows)[0].place_ns, 1'250'000'000);
  const std::vector<CandidateFate> fates = {
      CandidateFate::accepted_by_features, CandidateFate::accepted_by_depth,
      CandidateFate::accepted_by_tracker,  CandidateFate::no_pose,
      CandidateFate::depth_differs,        CandidateFate::poses_differ};
  for (std::size_t i = 0; i < fates.size(); ++i) {
    EXPECT_EQ((*rows)[i].fate, fates[i]) << i;
    EXPECT_EQ((*rows)[i].is_accepted(), i < 3) << i;
  }
}

TEST_F(LoopTable, NamesTheLineOfWhatIsNoCandidate) {
  for (const auto& [verdict, problem] :
       {std::pair{"features,perhaps,\"?\"", "decision 'perhaps'"},
        std::pair{"nothing,accepted,\"?\"", "accepted, verified by 'nothing'"},
        std::pair{"features,refused,no, unquoted", "21 cells (expected 20)"},
        std::pair{"features,refused,\"a\",", "21 cells (expected 20)"}}) {
    const auto rows = read_candidate_table(
        write("loops.csv", kHeader + line(kPose, "depth,accepted,\"agrees\"") + line(kPose, verdict)));
    ASSERT_FALSE(rows.has_value()) << verdict;
    EXPECT_EQ(rows.error().code, ErrorCode::data_corrupt);
    testing::expect_contains(rows.error().message, "loops.csv:3: ");
    testing::expect_contains(rows.error().message, problem);
  }
  EXPECT_EQ(read_candidate_table(folder_ / "none.csv").error().code, ErrorCode::data_missing);
}

TEST_F(LoopTable, ReadsPlaces) {
  const auto rows =
      read_place_table(write("places.csv", "timestamp_s,blur_px,candidates,accepted\n1.5,0.25,8,1\n"));
  ASSERT_TRUE(rows.has_value()) << rows.error().message;
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ(rows->front().timestamp_ns, 1'500'000'000);
  EXPECT_EQ(rows->front().blur_px, 0.25);
  EXPECT_EQ(rows->front().candidates, 8);
  EXPECT_EQ(rows->front().accepted, 1);
  const auto wrong =
      read_place_table(write("wrong.csv", "timestamp_s,blur_px,candidates,accepted\n1.5,,8,1\n"));
  ASSERT_FALSE(wrong.has_value());
  testing::expect_contains(wrong.error().message, "wrong.csv:2: blur_px is empty");
}

}  // namespace
}  // namespace fusebench
