#include "eval/record/clock_note.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace record;

namespace {

RunRecord record_with_clock(double offset_s, double sigma_s, bool applied) {
  RunRecord record;
  record.recording.truth = "given";
  record.metrics.reference_clock = {
      reference_clock::ReferenceClock{
          {offset_s, sigma_s, 100}, applied, {0.052, 0.03, 0.04, 540}, {0.041, 0.02, 0.03, 12}},
      {}};
  return record;
}

TEST(ClockNote, ReportsASignificantOffsetThatIsNotApplied) {
  EXPECT_EQ(clock_note(record_with_clock(0.066, 0.002, false)),
            "the reference clock is 66 +- 2 ms off; ATE 4.10 instead of 5.20 cm with --set "
            "evaluation.reference_time_offset=fitted");
  EXPECT_EQ(clock_note(record_with_clock(-0.0123, 0.0004, false)),
            "the reference clock is -12.3 +- 0.4 ms off; ATE 4.10 instead of 5.20 cm with --set "
            "evaluation.reference_time_offset=fitted");
  RunRecord without_ate = record_with_clock(0.066, 0.002, false);
  without_ate.metrics.reference_clock.value->fitted.ate_rmse_m.reset();
  EXPECT_EQ(
      clock_note(without_ate),
      "the reference clock is 66 +- 2 ms off; corrected with --set evaluation.reference_time_offset=fitted");
}

TEST(ClockNote, IsAbsentWhereThereIsNothingToDo) {
  EXPECT_FALSE(clock_note(record_with_clock(0.066, 0.002, true)));
  EXPECT_FALSE(clock_note(record_with_clock(0.009, 0.0001, false)));
  EXPECT_FALSE(clock_note(record_with_clock(0.066, 0.02, false)));
  EXPECT_FALSE(clock_note(RunRecord{}));
}

TEST(ClockNote, SaysWhyFittedChangesNothing) {
  RunRecord record;
  record.recording.truth = "given";
  record.metrics.reference_clock.reason = "the clock offset is not observable";
  EXPECT_FALSE(clock_note(record));
  record.config = {{"evaluation.reference_time_offset", std::string("fitted"), "--set"}};
  EXPECT_EQ(clock_note(record),
            "evaluation.reference_time_offset = fitted changes nothing: the clock offset is not observable");
  record.recording.truth = "none";
  EXPECT_FALSE(clock_note(record));
}

}  // namespace
}  // namespace fusebench
