#include "core/base/upper_median.hpp"

#include <gtest/gtest.h>

namespace fusebench {
namespace {

TEST(UpperMedian, OfAnEvenNumberIsTheLargerOfTheTwoInTheMiddle) {
  EXPECT_EQ(upper_median(std::vector{5}), 5);
  EXPECT_EQ(upper_median(std::vector{9, 1, 5}), 5);
  EXPECT_EQ(upper_median(std::vector{9.0, 1.0, 5.0, 7.0}), 7.0);
}

}  // namespace
}  // namespace fusebench
