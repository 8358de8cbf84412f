// calibration.toml and calib.txt, malformed.
#include <gtest/gtest.h>

#include "datasets/calibration/infinitam_calibration.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "tests/datasets/malformed_text.hpp"

namespace fusebench {

using namespace calibration;

namespace {

using namespace testing;

const std::string kToml =
    "calibration_source = \"a test\"\n"                 // line 1
    "[color]\n"                                         // 2
    "width_px = 640\n"                                  // 3
    "height_px = 480\n"                                 // 4
    "fx_px = 608.5\n"                                   // 5
    "fy_px = 607.5\n"                                   // 6
    "cx_px = 331.5\n"                                   // 7
    "cy_px = 245.5\n"                                   // 8
    "distortion = [0.0625, -0.125, 0.001, 0.002, 0]\n"  // 9
    "[depth]\n"                                         // 10
    "units_per_metre = 1000\n";                         // 11

struct Edit {
  std::string from;
  std::string to;
  int line = 0;           ///< that the error names; 0: the file
  const char* part = "";  ///< of the error; empty: read as the original
};

class MalformedCalibration : public InTemporaryFolder {
 protected:
  Result<std::optional<RigCalibration>> read(const std::string& content) const {
    write("calibration.toml", content);
    return read_calibration_beside(folder_);
  }
  void expect_refused(const std::string& content, int line, std::string_view part) const {
    const auto got = read(content);
    ASSERT_FALSE(got) << content.substr(0, 500);
    expect_refusal(got.error(), folder_ / "calibration.toml", line, part);
  }
};

TEST_F(MalformedCalibration, UnusualButSoundFilesReadTheSame) {
  const auto original = read(kToml);
  ASSERT_TRUE(original && *original) << original.error().message;
  EXPECT_EQ((*original)->color.pinhole.fx_px, 608.5);
  for (const std::string& content :
       {replaced(kToml, "\n", "\r\n"), "\xEF\xBB\xBF" + kToml, replaced(kToml, " = ", "\t=\t"),
        replaced(kToml, "\n", " \t# a comment\n\n"), kToml.substr(0, kToml.size() - 1),
        replaced(kToml, "fx_px = 608.5", "fx_px = +6.085e2"), replaced(kToml, "fx_px", "\"fx_px\"")}) {
    const auto got = read(content);
    ASSERT_TRUE(got && *got) << content << got.error().message;
    EXPECT_EQ(to_toml(**got), to_toml(**original));
  }
}

TEST_F(MalformedCalibration, BrokenLinesAreNamed) {
  const std::vector<Edit> edits = {
      {"608.5", "nan", 5, "color.fx_px must be a number from"},
      {"608.5", "inf", 5, "color.fx_px must be a number from"},
      {"608.5", "-608.5", 5, "color.fx_px must be a number from"},
      {"608.5", "0", 5, "color.fx_px must be a number from"},
      {"608.5", "1e308", 5, "color.fx_px must be a number from"},
      {"608.5", "1e-320", 5, ""},
      {"608.5", "1e999", 5,
       "not valid TOML: Error while parsing floating-point: '1e999' is not representable in 64 bits"},
      {"608.5", "99999999999999999999", 5, "not valid TOML"},
      {"608.5", std::string(400, '9'), 5, "not valid TOML"},
      {"608.5", "608,5", 5, "not valid TOML"},
      {"608.5", "\"608.5\"", 5, "color.fx_px must be a number from"},
      {"608.5", "[608.5]", 5, "color.fx_px must be a number from"},
      {"608.5", "2024-01-01", 5, "color.fx_px must be a flag, a number, a text or a list"},
      {"608.5", "", 5, "not valid TOML"},
      {"fx_px = 608.5\n", "", 2, "[color] needs the key fx_px"},
      {"fx_px", "fx", 5, "unknown key 'color.fx' (nearest: fx_px)"},
      {"fx_px", "\"f\\u0000x\"", 5, "is no name of letters"},
      {"fx_px", std::string(300, 'f'), 5, "is no name of letters"},
      {"fx_px = 608.5", "fx_px = 608.5\nfx_px = 608.5", 6, "not valid TOML"},
      {"608.5", std::string("6\0", 2), 5, "not valid TOML"},
      {"a test", "caf\xE9", 1, "not valid TOML"},
      {"\"a test\"", "7", 1, "calibration_source must be a text"},
      {"640", "1000000000", 3, "color.width_px must be a number from"},
      {"640", "-1", 3, "color.width_px must be a number from"},
      {"[0.0625, -0.125, 0.001, 0.002, 0]", "[]", 9, "must be a list of 5 finite numbers"},
      {"-0.125", "nan", 9, "must be a list of 5 finite numbers"},
      {"-0.125", "\"a\"", 9, "must be a list of 5 finite numbers"},
      {"0.002, 0]", "0.002]", 9, "must be a list of 5 finite numbers"},
      {"0.002, 0]", "0.002, 0", 10, "not valid TOML"},
      {"1000", "0", 11, "depth.units_per_metre = 0 (allowed: 0.1 to"},
      {"[depth]", "[lens]", 11, "unknown key 'lens.units_per_metre'"},
      {"[depth]", "[depth", 10, "not valid TOML"},
      {"units_per_metre = 1000", "T_color_depth = [1,0,0,0, 0,1,0,0, 0,0,1,0]", 10, "[depth]"},
      {"[depth]", "[imu]\n[depth]", 10, "[imu]"},
      {"[depth]", joined(Rows(600, "a"), ".") + "b = 1\n[depth]", 10, "more than 500 dots in a line"},
      {"[depth]", std::string(100'000, '['), 10, "not valid TOML"},
  };
  for (const Edit& edit : edits) {
    SCOPED_TRACE(edit.from + " -> " + edit.to.substr(0, 100));
    if (edit.part == std::string_view()) continue;
    expect_refused(replaced(kToml, edit.from, edit.to), edit.line, edit.part);
  }
}

TEST_F(MalformedCalibration, WholeFiles) {
  expect_refused("", 0, "[color] needs the key");
  expect_refused("# nothing\n", 0, "[color] needs the key");
  expect_refused(utf16(kToml, false), 1, "not valid TOML");
  expect_refused(utf16(kToml, true), 1, "not valid TOML");
  expect_refused(replaced(kToml, "\n", "\r"), 1, "not valid TOML");
  expect_refused(std::string("\x89PNG\r\n\x1A\n", 8), 1, "not valid TOML");
  expect_refused(kToml.substr(0, kToml.find("fy_px") + 3), 6, "not valid TOML");
  const auto absent = read_calibration_beside(folder_ / "none");
  EXPECT_TRUE(absent && !*absent) << "a recording need not have one";
  std::filesystem::remove(folder_ / "calibration.toml");
  std::filesystem::create_directory(folder_ / "calibration.toml");
  expect_refusal(read_calibration_beside(folder_).error(), folder_ / "calibration.toml", 0,
                 "cannot be opened");
}

const std::string kCalibTxt =
    "640 480\n600 601\n320 240\n\n"      // lines 1 to 3
    "640 480\n580 581\n319 239\n\n"      // 5 to 7
    "1 0 0 -0.05\n0 1 0 0\n0 0 1 0\n\n"  // 9 to 11
    "affine 0.001 0.0\n";                // 13

TEST(MalformedCalibTxt, IsReadOrNamed) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& content) {
    return read_infinitam_calibration(folder.write("calib.txt", content));
  };
  for (const std::string& content :
       {kCalibTxt, replaced(kCalibTxt, "\n", "\r\n"), replaced(kCalibTxt, " ", "\t"),
        replaced(kCalibTxt, "\n", " % a comment\n"), replaced(kCalibTxt, "\n", " "),
        "\xEF\xBB\xBF" + kCalibTxt}) {
    const auto calibration = read(content);
    ASSERT_TRUE(calibration) << content << calibration.error().message;
    EXPECT_EQ(calibration->color.pinhole.fy_px, 601);
    EXPECT_DOUBLE_EQ(*calibration->depth_units_per_metre, 1000);
  }
  const std::vector<Edit> edits = {
      {"600 601", "nan 601", 2, "colour fx: expected a finite number"},
      {"600 601", "-600 601", 2, "colour fx = -600"},
      {"600 601", "1e308 601", 2, "colour fx = 1e+308"},
      {"640 480\n600", "640.5 480\n600", 1, "colour width = 640.5 is no whole number"},
      {"600 601", "600,,601", 2, "colour fy"},
      {"600 601", "600", 3, ""},
      {"600 601", std::string(400, '9') + " 601", 2, "colour fx"},
      {"600 601", std::string("6\0 601", 6), 2, "colour fx"},
      {"600 601", "\xFF\xFE 601", 2, "colour fx: expected a finite number, got '\\xFF\\xFE'"},
      {"320 240", "1e300 240", 3, "colour cx = 1e+300 (allowed: -1000000 to 1000000)"},
      {"1 0 0 -0.05", "1 0 0 -5000", 11, "T_color_depth has a translation of 5000 m (allowed up to 1000 m)"},
      {"1 0 0 -0.05", "2 0 0 -0.05", 11, "T_color_depth is no rigid transform"},
      {"affine", "disparity", 13, "depth scale"},
      {"0.001 0.0", "0 0.0", 13, "depth scale (metres per unit) = 0"},
      {"0.001 0.0", "1000 0.0", 13, "depth scale (metres per unit) = 1000 (allowed: above 0, up to 10)"},
      {"0.001 0.0", "0.001 1.0", 13, "offset of depth must be 0"},
      {"0.001 0.0", "0.001", 0, "ends before depth offset"},
      {kCalibTxt, "", 0, "ends before colour width"},
      {kCalibTxt, utf16(kCalibTxt, false), 1, "colour width"},
  };
  for (const Edit& edit : edits) {
    SCOPED_TRACE(edit.from.substr(0, 20) + " -> " + edit.to.substr(0, 60));
    const auto refused = read(replaced(kCalibTxt, edit.from, edit.to));
    ASSERT_FALSE(refused);
    if (edit.part != std::string_view())
      expect_refusal(refused.error(), folder.path() / "calib.txt", edit.line, edit.part);
  }
}

}  // namespace
}  // namespace fusebench
