#include "core/base/io/input_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "core/base/io/fingerprint.hpp"
#include "core/base/io/text_table.hpp"
#include "core/config/toml_document.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

namespace {

namespace fs = std::filesystem;

/// Nobody ever writes into the pipe: what opens it never returns.
class InputFile : public testing::InTemporaryFolder {
 protected:
  InputFile() {
    EXPECT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    fs::create_symlink(folder_ / "nothing", folder_ / "dangling");
    fs::create_symlink("/dev/zero", folder_ / "zeros");
  }
};

TEST_F(InputFile, ReadsFilesAndLinksToThem) {
  const fs::path file = write("file", "text");
  fs::create_symlink(file, folder_ / "link");
  for (const fs::path& name : {file, folder_ / "link"}) {
    std::ifstream stream = io::input_file(name);
    std::string text;
    EXPECT_TRUE(std::getline(stream, text)) << name;
    EXPECT_EQ(text, "text");
  }
}

TEST_F(InputFile, OpensNothingElse) {
  for (const char* const name : {"pipe", "zeros", "dangling", "absent", "."})
    EXPECT_FALSE(io::input_file(folder_ / name)) << name;
}

TEST_F(InputFile, ALinkToNothingIsNamedAllTheSame) {
  EXPECT_TRUE(io::is_named(folder_ / "dangling"));
  EXPECT_TRUE(io::is_named(folder_ / "pipe"));
  EXPECT_FALSE(io::is_named(folder_ / "absent"));
}

TEST_F(InputFile, ReadersRefuseAPipe) {
  const fs::path pipe = folder_ / "pipe";
  EXPECT_FALSE(io::TextTable::open(pipe, "a b"));
  EXPECT_FALSE(config::read_toml(pipe));
  io::Fingerprint fingerprint;
  EXPECT_FALSE(fingerprint.add_file(pipe));
}

}  // namespace
}  // namespace fusebench
