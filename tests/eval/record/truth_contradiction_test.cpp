#include "eval/record/truth_contradiction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench {

using namespace record;

namespace {

/// A circle of this radius, which is also the rms extent of its positions.
Trajectory circle(double radius_m) {
  Trajectory trajectory;
  for (int i = 0; i < 40; ++i) {
    const double angle_rad = radians(9.0 * i);
    trajectory.push_back(
        {i * 33'000'000LL,
         {Quaterniond::Identity(), radius_m * Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0)}});
  }
  return trajectory;
}

RunRecord record_with_ate(double ate_rmse_m) {
  RunRecord record;
  record.status = RunStatus::ok;
  record.metrics.ate.value.emplace();
  record.metrics.ate.value->stats.rmse = ate_rmse_m;
  return record;
}

TEST(TruthContradiction, IsAnErrorAboveHalfOfTheExtent) {
  EXPECT_FALSE(truth_contradiction(circle(1), circle(1), 0.49));
  const auto text = truth_contradiction(circle(1), circle(1.2), 0.51);
  ASSERT_TRUE(text);
  EXPECT_EQ(*text,
            "the poses contradict the ground truth: ATE 0.51 m, and its positions are within 1.00 m (rms) of "
            "their mean, those of the run within 1.20 m; `fusebench inspect` on the recording looks for the "
            "reason");
}

TEST(TruthContradiction, SmallMotionsAreMeasuredAgainstATenthOfAMetre) {
  EXPECT_FALSE(truth_contradiction(circle(0.02), circle(0.02), 0.04));
  EXPECT_TRUE(truth_contradiction(circle(0.02), circle(0.02), 0.06));
}

TEST(TruthContradiction, WithoutAnAteTheExtentsDecide) {
  EXPECT_TRUE(truth_contradiction(circle(0), circle(0.4), std::nullopt));
  EXPECT_FALSE(truth_contradiction(circle(0.4), circle(0.5), std::nullopt));
}

TEST(TruthContradiction, NeedsPosesOfBoth) {
  EXPECT_FALSE(truth_contradiction({}, circle(1), std::nullopt));
  EXPECT_FALSE(truth_contradiction(circle(1), {}, 3.0));
}

TEST(TruthContradiction, IsKeptInTheNotesOfARunThatIsOk) {
  RunRecord record = record_with_ate(0.85);
  EXPECT_FALSE(noted_contradiction(record));
  note_contradiction(record, circle(1.2), circle(1.2));
  ASSERT_EQ(record.recording.notes.size(), 1U);
  EXPECT_TRUE(is_contradiction(record.recording.notes[0]));
  ASSERT_TRUE(noted_contradiction(record));
  EXPECT_TRUE(noted_contradiction(record)->starts_with("the poses contradict the ground truth: ATE 0.85 m"));
  RunRecord lost = record_with_ate(0.85);
  lost.status = RunStatus::lost;
  note_contradiction(lost, circle(1.2), circle(1.2));
  EXPECT_TRUE(lost.recording.notes.empty());
}

TEST(TruthContradiction, OfPosesOfAnotherProgramPointsToTheirConventions) {
  RunRecord imported = record_with_ate(0.85);
  note_contradiction(imported, circle(1.2), circle(1.2));
  EXPECT_NE(noted_contradiction(imported)->find("--align sim3"), std::string::npos);
  EXPECT_NE(noted_contradiction(imported)->find("--pose world_to_camera"), std::string::npos);
  EXPECT_EQ(noted_contradiction(imported)->find("inspect"), std::string::npos);
  RunRecord own = record_with_ate(0.85);
  own.config = {{"terms.prior", std::string("imu"), "default"}};
  note_contradiction(own, circle(1.2), circle(1.2));
  EXPECT_NE(noted_contradiction(own)->find("fusebench inspect"), std::string::npos);
}

TEST(TruthContradiction, TheBetterOfOnlineAndFinalPosesCounts) {
  RunRecord record = record_with_ate(0.85);
  record.final_metrics = record_with_ate(0.1).metrics;
  note_contradiction(record, circle(1.2), circle(1.2));
  EXPECT_TRUE(record.recording.notes.empty());
}

}  // namespace
}  // namespace fusebench
