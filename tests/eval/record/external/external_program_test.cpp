#include "eval/record/external/external_program.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "eval/record/external/program_files.hpp"
#include "eval/record/process/program_run.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace external;

namespace {

const std::string kLeast =
    "name = \"mine\"\ncommand = [\"sh\", \"-c\", \"true {output}\"]\n[trajectory]\nfile = \"poses.txt\"\n";

class ExternalProgramFile : public testing::InTemporaryFolder {
 protected:
  Result<ExternalProgram> read(const std::string& text) {
    write("mine.toml", text);
    auto program = read_external_program(folder_ / "mine.toml");
    if (!program) return program;
    if (auto found = find_installed(*program); !found) return tl::unexpected(found.error());
    return program;
  }
  std::string refused(const std::string& text) {
    const auto program = read(text);
    return program ? "accepted" : program.error().message + " | " + program.error().hint;
  }
};

TEST_F(ExternalProgramFile, HasDefaultsThatAreSafe) {
  const auto program = read(kLeast);
  ASSERT_TRUE(program.has_value()) << program.error().message;
  EXPECT_EQ(program->name, "mine");
  EXPECT_FALSE(program->input.has_value());
  EXPECT_EQ(program->repetitions, 5) << "of what may draw at random";
  EXPECT_FALSE(program->trajectory.online) << "a claim to be made, not assumed";
  EXPECT_EQ(program->imu, "none");
  EXPECT_TRUE(program->absent.empty());
  EXPECT_EQ(program->identity.size(), 32U);
  EXPECT_GT(program->limits.time_s, 0);
}

TEST_F(ExternalProgramFile, ChangesItsIdentityWithItsFilesAndItsVersion) {
  const std::string named =
      "name = \"mine\"\ncommand = [\"sh\", \"{folder}/run.sh\"]\nversion = [\"cat\", \"{folder}/version\"]\n"
      "[trajectory]\nfile = \"p\"\n";
  write("run.sh", "true\n");
  write("version", "1.0\nand more\n");
  const auto first = read(named);
  ASSERT_TRUE(first.has_value()) << first.error().message;
  EXPECT_EQ(first->version, "1.0");
  EXPECT_EQ(read(named)->identity, first->identity);
  write("version", "1.1\n");
  const auto second = read(named);
  EXPECT_NE(second->identity, first->identity);
  write("run.sh", "false\n");
  EXPECT_NE(read(named)->identity, second->identity);
}

TEST_F(ExternalProgramFile, ChangesItsIdentityWithEveryFileThatItsCommandNames) {
  const std::string model = write("data/model.bin", "one").string();
  const std::string vocabulary = write("data/vocabulary.txt", "one").string();
  const std::string engine = write("bin/mine-engine", "#!/bin/sh\ntrue\n").string();
  std::filesystem::permissions(engine, std::filesystem::perms::owner_all);
  write("run.sh", "#!/bin/sh\nexec mine-engine \"$1\"\n");
  setenv("MINE_VOCABULARY", vocabulary.c_str(), 1);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (path + ":" + (folder_ / "bin").string()).c_str(), 1);
  const std::string definitions[] = {
      "command = [\"sh\", \"-c\", \"exec mine-engine \\\"$MINE_VOCABULARY\\\" --model=" + model + "\"]",
      "command = [\"sh\", \"{folder}/run.sh\", \"--model=" + model + "\", \"$MINE_VOCABULARY\"]"};
  for (const std::string& command : definitions) {
    const std::string text = "name = \"mine\"\n" + command + "\n[trajectory]\nfile = \"p\"\n";
    const auto first = read(text);
    ASSERT_TRUE(first.has_value()) << first.error().message;
    for (const char* const file : {"data/model.bin", "data/vocabulary.txt", "bin/mine-engine"}) {
      const std::string before = read(text)->identity;
      write(file, testing::read_bytes(folder_ / file) + "\n# changed");
      EXPECT_NE(read(text)->identity, before) << command << " " << file;
    }
    EXPECT_EQ(read(text)->identity, read(text)->identity);
  }
  setenv("PATH", path.c_str(), 1);
  unsetenv("MINE_VOCABULARY");
}

TEST(FilesOfCommand, AreThoseThatAreNamedAndNotTheSystems) {
  const testing::TemporaryFolder folder;
  const auto script = folder.write("run.py", "#!/bin/sh\nls\n");
  const auto files =
      files_of_command({"sh", "{folder}/run.py", "{recording}", "{output}/run.py", "ls"}, folder.path());
  ASSERT_EQ(files.size(), 2U) << "the script, the program itself and no other one of the system";
  EXPECT_EQ(files[0], script);
  EXPECT_EQ(files[1].filename(), "sh");
}

TEST_F(ExternalProgramFile, SaysWhatIsNotInstalled) {
  const auto absent = read("name = \"mine\"\ncommand = [\"no-such-program\"]\n[trajectory]\nfile = \"p\"\n");
  ASSERT_TRUE(absent.has_value());
  testing::expect_contains(absent->absent, "no-such-program is not installed");
  const auto broken = read(
      "name = \"mine\"\ncommand = [\"sh\"]\nversion = [\"sh\", \"-c\", \"echo no module; exit 3\"]\n"
      "[trajectory]\nfile = \"p\"\n");
  ASSERT_TRUE(broken.has_value());
  testing::expect_contains(broken->absent, "no module");
}

TEST_F(ExternalProgramFile, RefusesWhatItDoesNotKnowByFileAndLine) {
  testing::expect_contains(refused("nmae = \"mine\"\n" + kLeast),
                           "mine.toml:1: unknown key 'nmae' (nearest: name)");
  testing::expect_contains(refused("name = \"full\"\n"),
                           "mine.toml:1: name must be no variant of this program");
  testing::expect_contains(refused("name = \"a/b\"\n"), "must be letters, digits");
  testing::expect_contains(refused("name = \"mine\"\ncommand = [\"sh\", \"{outptu}\"]\n"),
                           "there is no placeholder {outptu}");
  testing::expect_contains(refused("name = \"mine\"\ncommand = \"sh\"\n"), "a list of texts");
  testing::expect_contains(refused(kLeast + "unit = \"cm\"\n"), "m or mm");
  testing::expect_contains(refused(kLeast + "format = \"tmu\"\n"), "formats are tum, kitti");
  testing::expect_contains(refused("export = \"rosbag\"\n" + kLeast), "export must be none, tum, infinitam");
  testing::expect_contains(refused("name = \"mine\"\n[trajectory]\nfile = \"../p\"\n"),
                           "a path below {output}");
  testing::expect_contains(refused("name = \"mine\"\n"), "a system needs command");
  testing::expect_contains(refused("repetitions = 2\n" + kLeast), "at least 5");
  EXPECT_EQ(read("deterministic = true\n" + kLeast)->repetitions, 1);
}

TEST(ProgramRun, GivesCodeOutputAndCost) {
  const auto go_on = [] { return true; };
  const auto end = process::run_program({"sh", "-c", "echo said; echo wrong >&2; exit 3"}, "/tmp", {}, go_on);
  ASSERT_TRUE(end.has_value()) << end.error().message;
  EXPECT_FALSE(end->succeeded);
  EXPECT_EQ(end->how, "exit code 3");
  testing::expect_contains(end->output, "said");
  testing::expect_contains(end->output, "wrong");
  EXPECT_GT(end->peak_rss_bytes, 0U);
  EXPECT_TRUE(process::run_program({"sh", "-c", "true"}, "/tmp", {}, go_on)->succeeded);
  const auto killed = process::run_program({"sh", "-c", "kill -9 $$"}, "/tmp", {}, go_on);
  testing::expect_contains(killed->how, "signal 9");
  const auto none = process::run_program({"no-such-program"}, "/tmp", {}, go_on);
  ASSERT_FALSE(none.has_value());
  testing::expect_contains(none.error().message, "no-such-program: cannot be started: No such file");
}

TEST(ProgramRun, KillsWhatHangsWithAllThatItStarted) {
  const auto end = process::run_program({"sh", "-c", "sleep 1000 & echo $!; sleep 1000"}, "/tmp", {1.5, 0},
                                        [] { return true; });
  ASSERT_TRUE(end.has_value());
  EXPECT_FALSE(end->succeeded);
  EXPECT_EQ(end->how, "killed after 1.5 s, its limit");
  const std::string child = end->output.substr(0, end->output.find('\n'));
  ASSERT_FALSE(child.empty()) << "the shell had no time to start";
  // Gone, or a zombie that its new parent has not waited for yet.
  std::ifstream status("/proc/" + child + "/stat");
  std::string number, name, state = "gone";
  status >> number >> name >> state;
  EXPECT_TRUE(state == "gone" || state == "Z" || state == "X") << state;
  const auto stopped = process::run_program({"sleep", "1000"}, "/tmp", {}, [] { return false; });
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().message, "stopped by the user");
}

}  // namespace
}  // namespace fusebench
