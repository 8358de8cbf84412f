#include "core/base/io/stamp_unit.hpp"

#include <gtest/gtest.h>

#include "core/base/io/stamped_rows.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;

namespace {

TEST(StampUnit, BySizeSince1970) {
  EXPECT_EQ(unit_by_size("1403636579.763555584"), TimeUnit::seconds);
  EXPECT_EQ(unit_by_size("1403636579763.555"), TimeUnit::milliseconds);
  EXPECT_EQ(unit_by_size("1403636579763555"), TimeUnit::microseconds);
  EXPECT_EQ(unit_by_size("1.403636579763555584e+18"), TimeUnit::nanoseconds);
  EXPECT_EQ(unit_by_size("12345678901"), TimeUnit::seconds) << "below 1e11: from the start of a recording";
  EXPECT_EQ(unit_by_size("noon"), TimeUnit::seconds);
}

TEST(StampUnit, DecimalsThatAUnitDoesNotHave) {
  EXPECT_EQ(stamp_decimals("12.340"), 2);
  EXPECT_EQ(stamp_decimals("12.000"), 0);
  EXPECT_EQ(stamp_decimals("100"), 0);
  EXPECT_EQ(stamp_decimals("0.5"), 1);
  EXPECT_EQ(stamp_decimals("1.5e-3"), 4);
  EXPECT_EQ(stamp_decimals("1.403636579763555584e+18"), 0);
  EXPECT_FALSE(can_be_in(TimeUnit::nanoseconds, "12.345678901"));
  EXPECT_TRUE(can_be_in(TimeUnit::nanoseconds, "12345678901.0")) << "as pandas writes integers";
  EXPECT_TRUE(can_be_in(TimeUnit::microseconds, "12.345"));
  EXPECT_FALSE(can_be_in(TimeUnit::microseconds, "12.3456"));
  EXPECT_TRUE(can_be_in(TimeUnit::milliseconds, "12.345678"));
  EXPECT_TRUE(can_be_in(TimeUnit::seconds, "12.34567890123"));
  EXPECT_FALSE(can_be_in(TimeUnit::seconds, "1403636579763555584")) << "beyond 146 years";
}

TEST(StampedRows, UnitOfAListIsBySizeWithAWarning) {
  const testing::TemporaryFolder folder;
  const auto stamps_of = [&](std::string_view text, std::vector<std::string>& warnings) {
    std::vector<std::int64_t> stamps;
    const auto done = for_each_stamped_row(
        folder.write("rgb.txt", text), "timestamp filename", TimeOrder::increasing,
        [&](const TextTable&, std::int64_t time_ns) -> Result<void> {
          stamps.push_back(time_ns);
          return {};
        },
        warnings);
    EXPECT_TRUE(done) << done.error().message;
    return stamps;
  };
  std::vector<std::string> warnings;
  const std::vector<std::int64_t> expected = {1305031102175304000, 1305031102211214000};
  EXPECT_EQ(stamps_of("1305031102.175304 a\n1305031102.211214 b\n", warnings), expected);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(stamps_of("# x\n1305031102175304000 a\n1305031102211214000 b\n", warnings), expected);
  EXPECT_EQ(stamps_of("1305031102175304 a\n1305031102211214 b\n", warnings), expected);
  EXPECT_EQ(stamps_of("1305031102175.304 a\n1305031102211.214 b\n", warnings), expected);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_TRUE(warnings[0].ends_with("rgb.txt:2: stamps are read as nanoseconds, by their size"))
      << warnings[0];
}

}  // namespace
}  // namespace fusebench
