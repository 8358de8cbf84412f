#include "core/steps/frame_update.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fusebench {

using core::agreement;
using measurement::PatchOutcome;

namespace {

PatchOutcome outcome(bool in_view, bool tracked, double correlation) {
  PatchOutcome result;
  result.in_view = in_view;
  result.tracked = tracked;
  result.correlation = correlation;
  return result;
}

TEST(Agreement, IsTheMeanCorrelationOfPatchesInView) {
  EXPECT_EQ(agreement({}), 0);
  const std::vector<PatchOutcome> outcomes = {outcome(true, true, 0.9), outcome(true, true, 0.5),
                                              outcome(false, false, 0.0)};
  EXPECT_DOUBLE_EQ(agreement(outcomes), 0.7);
}

TEST(Agreement, APatchThatIsNotTrackedCountsAsZero) {
  const std::vector<PatchOutcome> outcomes = {outcome(true, true, 0.8), outcome(true, false, 0.8)};
  EXPECT_DOUBLE_EQ(agreement(outcomes), 0.4);
}

}  // namespace
}  // namespace fusebench
