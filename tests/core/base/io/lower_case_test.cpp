#include "core/base/io/lower_case.hpp"

#include <gtest/gtest.h>

namespace fusebench {
namespace {

TEST(LowerCase, ChangesLettersOfAsciiAlone) {
  EXPECT_EQ(io::lower_case("Rad-Tan 09 AZ[`{@"), "rad-tan 09 az[`{@");
  EXPECT_EQ(io::lower_case("\xC3\x84"), "\xC3\x84");
}

}  // namespace
}  // namespace fusebench
