#include "core/base/printable.hpp"

#include <gtest/gtest.h>

namespace fusebench {
namespace {

TEST(Printable, ShowsEveryByteInOneShortLine) {
  EXPECT_EQ(printable("rgb/1.png"), "rgb/1.png");
  EXPECT_EQ(printable("a\tb\n"), "a\\x09b\\x0A");
  EXPECT_EQ(printable("caf\xE9\x1B[31m"), "caf\\xE9\\x1B[31m");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("12345", 5), "12345");
  EXPECT_EQ(printable("123456", 5), "12345...");
  EXPECT_EQ(printable(std::string(1000, '\xFF'), 8), "\\xFF\\xFF...");
  EXPECT_EQ(printable(""), "");
}

}  // namespace
}  // namespace fusebench
