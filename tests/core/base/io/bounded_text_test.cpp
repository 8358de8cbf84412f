#include "core/base/io/bounded_text.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;

namespace {

std::vector<std::string> lines_of(std::istream& stream, bool by_library) {
  std::vector<std::string> lines;
  std::string line;
  while (by_library ? static_cast<bool>(std::getline(stream, line)) : next_line(stream, line))
    lines.push_back(line);
  return lines;
}

TEST(NextLine, IsGetline) {
  for (const char* text : {"", "\n", "a", "a\n", "a\nb", "a\n\nb\n", "\n\n", "a\r\nb\r\n", "a\n\n"}) {
    std::istringstream mine(text);
    std::istringstream theirs(text);
    EXPECT_EQ(lines_of(mine, false), lines_of(theirs, true)) << text;
    EXPECT_EQ(mine.eof(), theirs.eof()) << text;
    EXPECT_FALSE(mine.bad());
  }
}

TEST(NextLine, EndsAtALineThatIsNone) {
  std::istringstream just(std::string(kMostLineBytes, 'x') + "\nb\n");
  EXPECT_EQ(lines_of(just, false).size(), 2U);
  EXPECT_FALSE(just.bad());
  std::istringstream beyond("a\n" + std::string(kMostLineBytes + 1, 'x') + "\nb\n");
  EXPECT_EQ(lines_of(beyond, false), std::vector<std::string>{"a"});
  EXPECT_TRUE(beyond.bad());
}

TEST(WholeText, IsBounded) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("a.json", "12345");
  EXPECT_EQ(whole_text(file, 5, "record").value(), "12345");
  const auto refused = whole_text(file, 4, "record");
  ASSERT_FALSE(refused);
  testing::expect_contains(refused.error().message, "a.json: 5 bytes, more than any record has (4)");
  EXPECT_EQ(refused.error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(whole_text(folder.path() / "none", 4, "record").error().code, ErrorCode::data_missing);
  EXPECT_EQ(whole_text(folder.path(), 4, "record").error().code, ErrorCode::data_missing) << "a folder";
}

}  // namespace
}  // namespace fusebench
