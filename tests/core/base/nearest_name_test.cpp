#include "core/base/nearest_name.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"full", "no-imu", "tsdf.voxel_m", "depth.max_m"};

TEST(NearestName, FindsAMisspeltName) {
  EXPECT_EQ(nearest_name("ful", kNames), "full");
  EXPECT_EQ(nearest_name("no_imu", kNames), "no-imu");
  EXPECT_EQ(nearest_name("flul", kNames), "full") << "neighbours are exchanged";
}

TEST(NearestName, ExchangedLettersAreOneMistake) {
  EXPECT_EQ(nearest_name("rnu", std::array<std::string_view, 2>{"list", "run"}), "run");
  EXPECT_EQ(nearest_name("smi3", std::array<std::string_view, 2>{"se3", "sim3"}), "sim3");
}

TEST(NearestName, FindsAMisspeltPartOfALongName) {
  EXPECT_EQ(nearest_name("voxel", kNames), "tsdf.voxel_m");
  EXPECT_EQ(nearest_name("tsdf.voxl", kNames), "tsdf.voxel_m");
}

TEST(NearestName, ABeginningWinsOverWhatIsNearer) {
  constexpr std::array<std::string_view, 6> kFlags = {"--max",     "--par", "--variant",
                                                      "--threads", "--out", "--preset"};
  EXPECT_EQ(nearest_name("--var", kFlags), "--variant");
  EXPECT_EQ(nearest_name("--thr", kFlags), "--threads");
  EXPECT_EQ(nearest_name("--pre", kFlags), "--preset");
  EXPECT_EQ(nearest_name("--p", kFlags), "") << "too short a beginning";
  EXPECT_EQ(nearest_name("--foo", kFlags), "") << "dashes make nothing alike";
  constexpr std::array<std::string_view, 2> kBoth = {"--variants", "--variant"};
  EXPECT_EQ(nearest_name("--var", kBoth), "--variant");
  EXPECT_EQ(nearest_name("--var", std::array<std::string_view, 1>{"--a-very-long-name"}), "");
}

TEST(NearestName, ADissimilarNameHasNoHint) {
  EXPECT_EQ(nearest_name("beauty", kNames), "");
  EXPECT_EQ(nearest_name("zzz", kNames), "");
  EXPECT_EQ(nearest_name("", kNames), "");
  EXPECT_EQ(nearest_name("full", {}), "");
}

TEST(NearestName, HintsAreSentencesOrEmpty) {
  EXPECT_EQ(nearest_hint("ful", kNames), " (nearest: full)");
  EXPECT_EQ(nearest_hint("zzz", kNames), "");
  EXPECT_EQ(nearest_hint("ful", std::vector<std::string>{"no-imu", "full"}), " (nearest: full)");
  EXPECT_EQ(did_you_mean("ful", kNames), "did you mean full?");
  EXPECT_EQ(did_you_mean("zzz", kNames), "");
}

}  // namespace
}  // namespace fusebench
