#include "datasets/recording/reading/time_unit.hpp"

#include <string>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;
using namespace reading;

namespace {

class TimeUnitTest : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] Result<DetectedUnit> detect(std::string_view text, const SpacingRange& range) const {
    return detect_time_unit(write("list.txt", text), "timestamp", range);
  }
  [[nodiscard]] std::string refusal(std::string_view text) const {
    const auto found = detect(text, kImageSpacing);
    if (found) return "was not refused";
    EXPECT_EQ(found.error().code, ErrorCode::data_corrupt);
    return found.error().message;
  }
};

TEST_F(TimeUnitTest, EachUnitIsFoundWhateverTheHeaderSays) {
  const auto expect = [&](std::string_view text, const SpacingRange& range, TimeUnit unit, double spacing_s) {
    const auto found = detect(text, range);
    ASSERT_TRUE(found) << text << found.error().message;
    EXPECT_EQ(found->unit, unit) << text;
    EXPECT_NEAR(found->spacing_s, spacing_s, 1e-5) << text;
  };
  expect("#timestamp(ms)\n0.755517\n0.788792\n0.822067\n", kImageSpacing, TimeUnit::seconds, 0.033275);
  expect("1305031229.528748\n1305031229.562023\n", kImageSpacing, TimeUnit::seconds, 0.033275);
  expect("755.517\n788.792\n", kImageSpacing, TimeUnit::milliseconds, 0.033275);
  expect("755517\n788792\n", kImageSpacing, TimeUnit::microseconds, 0.033275);
  expect("#timestamp(ms)\n755517000.00\n788792000.00\n", kImageSpacing, TimeUnit::nanoseconds, 0.033275);
  expect("1305031229528748032\n1305031229562023000\n", kImageSpacing, TimeUnit::nanoseconds, 0.033275);
  expect("0.002\n0.007\n", kImuSpacing, TimeUnit::seconds, 0.005);
  expect("2000000\n7000000\n", kImuSpacing, TimeUnit::nanoseconds, 0.005);
}

TEST_F(TimeUnitTest, GapsAndJumpsDoNotMatter) {
  const auto found = detect("0\n33000\n66000\n9066000\n9099000\n9132000\n100\n", kImageSpacing);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->unit, TimeUnit::microseconds);
  EXPECT_EQ(found->note("COLOR.txt"), "COLOR.txt: times are in microseconds (a row every 33 ms)");
}

TEST_F(TimeUnitTest, RefusesWhatFitsNoUnit) {
  EXPECT_NE(refusal("1\n2\n3\n").find("rows are 1 apart in time (median), which is 5 to 250 ms in none"),
            std::string::npos);
  EXPECT_NE(refusal("5\n5\n5\n").find("rows are 0 apart"), std::string::npos);
  EXPECT_NE(refusal("5\n").find("has 1 rows, too few"), std::string::npos);
  EXPECT_NE(refusal("# nothing\n").find("has 0 rows"), std::string::npos);
  EXPECT_NE(refusal("5\nx\n").find("list.txt:2: timestamp: expected a finite number"), std::string::npos);
  EXPECT_EQ(detect_time_unit("/nonexistent", "timestamp", kImageSpacing).error().code,
            ErrorCode::data_missing);
}

TEST_F(TimeUnitTest, NoTwoUnitsFit) {
  EXPECT_LT(kImageSpacing.most_s / kImageSpacing.least_s, 1000);
  EXPECT_LT(kImuSpacing.most_s / kImuSpacing.least_s, 1000);
}

}  // namespace
}  // namespace fusebench
